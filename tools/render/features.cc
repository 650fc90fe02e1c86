// synpo-render features: scene files of the built-in kitchens, their views seen by a feature network.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "draw/vision/feature_net.h"
#include "format/scene.h"
#include "play/kitchen_scenes.h"
#include "render/render.h"
#include "stats/matrix/split.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/view/features.h"
#include "world/kitchen/view/view.h"
#include "world/world.h"

using namespace synpo;

int features(int argc, char** argv) {
  std::string world_name = "kitchen", net_path, envs, folder;
  int64_t layouts = 1, seed = 1, threads = 0;
  bool quiet = false;
  Options options(
      "synpo-render features", "--features FILE -o DIR [OPTION]...",
      "Writes a scene file for each kitchen: what its rules need, and the features that a network makes of all views.");
  options.text(0, "features", "FILE", "the network, ONNX: 224 x 224 pixels to 2048 features", net_path)
      .text('o', "output", "DIR", "the folder for the scene files; it is made where it is missing", folder)
      .choice('w', "world", "WORLD", "kitchen", world_name, {"kitchen"})
      .text(0, "envs", "LIST", "kitchens: how many, or names with commas between [all]", envs)
      .integer(0, "layouts", "N", "layouts of the objects in each kitchen, drawn at random", layouts, 1, 1000)
      .integer('s', "seed", "N", "seed of the layouts", seed, 0, INT64_MAX)
      .integer('j', "threads", "N", "threads; 0: as many as there are", threads, 0, 1024)
      .flag('q', "quiet", "no progress", quiet);
  options.parse(argc, argv);
  if (net_path.empty()) fail(Exit::kUsage, "--features FILE is missing");
  if (folder.empty()) fail(Exit::kUsage, "-o DIR is missing");

  catch_stop_signals();
  const KitchenSet world;
  const std::vector<std::string> chosen = choose_names("--envs", envs, world.env_names());
  FeatureNet net(net_path, kViewFeatures, int(threads));
  PictureFeatures pictures;
  pictures.name = net.name();
  pictures.hash = net.hash();
  pictures.picture_bytes = size_t(3) * FeatureNet::kSide * FeatureNet::kSide;
  pictures.draw = [](const KitchenSolids& scene, const KitchenFrame& frame, uint8_t* picture) {
    render(scene, frame, FeatureNet::kSide, FeatureNet::kSide, picture);
  };
  pictures.extract = [&](const uint8_t* all, int count, float* made) { net.extract(all, count, made); };

  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(Exit::kCantCreate, "cannot create the folder ", quoted(folder), ": ", error.message());
  const auto path_of = [&](const std::string& name) {
    return (std::filesystem::path(folder) / (name + kSceneEnding)).string();
  };
  for (const std::string& name : chosen) Output probe(path_of(name));
  Parallel parallel{int(threads)};
  Progress progress("synpo-render", "views", 0, quiet);
  for (size_t i = 0; i < chosen.size(); ++i) {
    const int env = world.env_index(chosen[i]);
    const Scene scene =
        make_scene(parallel, world, env, random_layouts(world, env, int(layouts), uint64_t(seed)), pictures,
                   [&](size_t done, size_t total) {
                     progress.set_total(uint64_t(total * chosen.size()));
                     progress.update(uint64_t(total * i + done), concat(chosen[i], ", ", i + 1, " of ", chosen.size()));
                     stop_if_asked();
                   });
    write_file(path_of(chosen[i]), format_scene(scene));
  }
  progress.finish();
  return 0;
}
