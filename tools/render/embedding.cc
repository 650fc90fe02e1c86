// synpo-render embedding: where a checkpoint's environments and tasks lie in their embedding spaces.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/world_face.h"
#include "draw/plot/embedding_picture.h"
#include "draw/worlds/faces.h"
#include "format/checkpoint.h"
#include "nn/buffer.h"
#include "nn/layout.h"
#include "play/model.h"
#include "policy/policy.h"
#include "render/render.h"
#include "stats/distance.h"
#include "world/world.h"

using namespace synpo;

namespace {

// A row of an embedding table, in the order of the picture.
struct Row {
  int index;
  std::string name;
};

// Embeddings as the policy uses them.
Embeddings read_embeddings(const Model& model, const TensorInfo* place, const std::string& title,
                           const std::vector<Row>& rows) {
  Embeddings out{title, {}, {}, model.shape.embedding, {}};
  for (const Row& row : rows) {
    out.names.push_back(row.name);
    const float* values = model.parameters.data() + place->offset + size_t(row.index) * out.size;
    double square = 0;
    for (int i = 0; i < out.size; ++i) square += double(values[i]) * values[i];
    const double factor = model.shape.normalise_embeddings && square > 0 ? std::sqrt(out.size / square) : 1;
    for (int i = 0; i < out.size; ++i) out.values.push_back(factor * values[i]);
  }
  return out;
}

std::string count_text(size_t drawn, int all) { return int(drawn) == all ? concat(all) : concat(drawn, " of ", all); }

}  // namespace

int embedding(int argc, char** argv) {
  EmbeddingStyle style;
  PictureOptions picture;
  std::string kind = "pca", metric = "cosine";
  bool all = false;
  Options options("synpo-render embedding", "[OPTION]... [CHECKPOINT]",
                  "Draws a checkpoint's embeddings of environments and of tasks side by side.");
  options.choice(0, "kind", "KIND", "pca: two principal components; distance: matrices", kind, {"pca", "distance"})
      .choice(0, "metric", "NAME", "distances: cosine or euclidean", metric, {"cosine", "euclidean"})
      .flag(0, "all", "environments and tasks of no seen pair too", all)
      .call(0, "title", "TEXT", "title above the picture", drawn(style.title));
  picture.add_to(options);
  const auto operands = options.parse(argc, argv, 0, 1);
  if (options.given("metric") && kind != "distance") fail(Exit::kUsage, "--metric is for --kind distance");
  picture.settle(options);
  style.scale = picture.scale;

  Output output = picture.open();
  const Checkpoint checkpoint = load_checkpoint(operands.empty() ? "-" : operands[0]);
  const std::shared_ptr<const World> restored = world_of(checkpoint);
  const World& world = *restored;
  const std::unique_ptr<const WorldFace> face = face_of(restored);
  const Model model = load_model(checkpoint, world);

  std::vector<Row> envs, tasks;
  const auto trained = [&](int EnvTask::*side, int index) {
    return all ||
           std::any_of(model.seen.begin(), model.seen.end(), [&](const EnvTask& pair) { return pair.*side == index; });
  };
  for (int i = 0; i < world.envs(); ++i)
    if (trained(&EnvTask::env, i)) envs.push_back({i, world.environments()[i].name});
  for (const int i : face->task_order())
    if (trained(&EnvTask::task, i)) tasks.push_back({i, world.task_names()[i]});

  std::vector<Embeddings> panels;
  std::string of;
  if (const TensorInfo* place = model.policy->embeddings(PairSide::kEnv)) {
    panels.push_back(read_embeddings(model, place, "environments", envs));
    of = concat(count_text(envs.size(), world.envs()), " environments and ");
  }
  if (const TensorInfo* place = model.policy->embeddings(PairSide::kTask)) {
    panels.push_back(read_embeddings(model, place, "tasks", tasks));
    of += concat(count_text(tasks.size(), world.task_count()), " tasks");
    for (const Row& row : tasks)
      if (const Sign sign = face->task_sign(row.index)) panels.back().marks.push_back(sign);
  }
  if (panels.empty()) fail(Exit::kData, "method ", quoted(model.method), " has no embeddings");
  const char* what = kind == "pca"        ? "principal components"
                     : metric == "cosine" ? "cosine distance"
                                          : "Euclidean distance";
  const std::string marked = face->task_sign_words();
  style.caption = concat(what, kind == "pca" ? "" : " (darker: nearer)", " of the embeddings of ", of, ", size ",
                         model.shape.embedding, "; ", model.method, ", ", counted(model.updates, "update"),
                         marked.empty() ? "" : "; a task's mark: " + marked);
  const Font font(picture.font);
  if (kind == "pca")
    picture.finish(output, draw_embedding_map(panels, style, font));
  else
    picture.finish(output, draw_embedding_distances(
                               panels, metric == "cosine" ? Distance::kCosine : Distance::kEuclidean, style, font));
  return 0;
}
