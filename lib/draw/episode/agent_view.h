// Figure 1: a moment of an episode as the reader sees it, beside it what the agent sees, and what the network gets.
#pragma once
#include <string>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/face/film.h"
#include "draw/face/world_face.h"

namespace synpo {

struct ViewStyle {
  bool history = false;  // the pictures of the last moments that the network gets, in a row beneath
  std::string title;     // empty: environment, task and step in words
  double scale = 2;      // pixels per point
};

// The last moment of an expert's film of the face's world.
Canvas draw_agent_view(const WorldFace& face, const Film& film, const ViewStyle& style, const Font& font);

}  // namespace synpo
