// Embeddings of environments and tasks: where they lie (principal components), and how far from one another.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "stats/distance.h"

namespace synpo {

// A panel of the picture.
struct Embeddings {
  std::string title;
  std::vector<std::string> names;
  std::vector<Sign> marks;  // stand beside the names and in the map; empty: dots
  int size;
  std::vector<double> values;  // [names, size]
};

struct EmbeddingStyle {
  std::string title, caption;
  double scale = 2;  // pixels per point
};

// Each panel has principal components of its own, with one unit on both axes, and the share of the variance that they
// explain.
Canvas draw_embedding_map(const std::vector<Embeddings>& panels, const EmbeddingStyle& style, const Font& font);

// A cell for every two names; each panel has a colour bar of its own, from the nearest two to the farthest.
Canvas draw_embedding_distances(const std::vector<Embeddings>& panels, Distance kind, const EmbeddingStyle& style,
                                const Font& font);

}  // namespace synpo
