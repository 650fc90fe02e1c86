// Loss, scores, gradients and Adam of every method against the numbers of tests/torch/torch_reference.py.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "format/safetensors.h"
#include "helpers/policy_fixture.h"
#include "helpers/targets.h"
#include "helpers/temporary.h"
#include "nn/adam.h"
#include "policy/method/synpo.h"

namespace synpo {
namespace {

// The worst relative error of each kind of result, over its tensors.
class Worst {
 public:
  void add(const std::string& kind, const std::string& name, double error, double limit = 1e-4) {
    EXPECT_LT(error, limit) << kind << " " << name;
    auto& [worst, where] = worst_[kind];
    if (!(error <= worst)) {
      worst = error;
      where = name;
    }
  }
  void print() const {
    for (const auto& [kind, worst] : worst_)
      std::printf("%-12s %.2e  %s\n", kind.c_str(), worst.first, worst.second.c_str());
  }

 private:
  std::map<std::string, std::pair<double, std::string>> worst_;
};

PolicyShape shape_of(const SafeTensors& dump) {
  const auto size = [&](const char* name) { return std::atoi(dump.meta(name).c_str()); };
  PolicyShape shape;
  if (dump.metadata.count("view")) {
    shape.observation = {Sight::kFeatures, 0, {}, size("view"), size("objects")};
    shape.views = {size("view_channels"), size("object_embedding"), size("view_hidden")};
  } else {
    shape.observation = grid_observation_spec();
    const std::string& channels = dump.meta("channels");
    EXPECT_EQ(std::sscanf(channels.c_str(), "%d,%d,%d,%d", &shape.channels[0], &shape.channels[1], &shape.channels[2],
                          &shape.channels[3]),
              4);
  }
  shape.actions = int(dump.tensors.at("logits").shape.at(1));
  shape.envs = size("envs");
  shape.tasks = size("tasks");
  shape.feature = size("feature");
  shape.basis = size("basis");
  shape.embedding = size("embedding");
  shape.hidden = size("hidden");
  shape.action_embedding = size("action_embedding");
  shape.head_hidden = size("head_hidden");
  shape.seam = size("seam");
  const std::string& loss = dump.meta("sf_loss");
  shape.sf_loss = loss == "td" ? SfLoss::kTemporalDifference : loss == "q" ? SfLoss::kPlannerQ : SfLoss::kCrossEntropy;
  return shape;
}

// The dump's [n, 16, 16, 3 * history] of pixel values as colour indices [n, 16, 16, history].
std::vector<uint8_t> colour_indices(const std::vector<uint8_t>& pixels) {
  std::map<int, uint8_t> index;
  for (int i = 0; i < kGridColours; ++i) index[kPalette[i].r << 16 | kPalette[i].g << 8 | kPalette[i].b] = uint8_t(i);
  std::vector<uint8_t> colours(pixels.size() / 3);
  for (size_t i = 0; i < colours.size(); ++i) {
    const auto found = index.find(pixels[3 * i] << 16 | pixels[3 * i + 1] << 8 | pixels[3 * i + 2]);
    if (found == index.end()) {
      ADD_FAILURE() << "a colour that the palette does not have";
      return colours;
    }
    colours[i] = found->second;
  }
  return colours;
}

std::vector<int> whole_numbers(const SafeTensors& dump, const char* name) {
  const std::vector<int64_t> values = dump.get<int64_t>(name);
  return {values.begin(), values.end()};
}

// One training step and what follows it, against the results of tests/torch/torch_reference.py in the file.
Worst compare_with_dump(const std::string& path) {
  Worst worst;
  Input input(path);
  const SafeTensors dump = read_safetensors(input);
  const PolicyShape shape = shape_of(dump);
  Network<float> net(shape, dump.meta("method"));
  const Layout& layout = net.policy->parameters();
  size_t tensors = 0;
  for (const auto& [name, tensor] : dump.tensors) tensors += name.starts_with("param.");
  EXPECT_EQ(tensors, layout.tensors().size());
  for (const TensorInfo& tensor : layout.tensors()) {
    dump.get("param." + tensor.name, net.parameters.data() + tensor.offset, tensor.size);
    EXPECT_EQ(dump.tensors.at("param." + tensor.name).shape,
              std::vector<int64_t>(tensor.shape.begin(), tensor.shape.end()))
        << tensor.name;
  }
  for (const TensorInfo& tensor : net.policy->statistics().tensors())
    std::fill_n(net.statistics.data() + tensor.offset, tensor.size, tensor.name.ends_with(".variance") ? 1.0f : 0.0f);
  const std::vector<uint8_t> observations = shape.observation.sight == Sight::kFeatures
                                                ? bytes_of(dump.get<float>("input"))
                                                : colour_indices(dump.get<uint8_t>("input"));
  const std::vector<int> env = whole_numbers(dump, "env"), task = whole_numbers(dump, "task"),
                         label = whole_numbers(dump, "label"), taken = whole_numbers(dump, "taken");
  const std::vector<float> reward = dump.get<float>("reward");
  StepBatch<float> batch = {.size = int(env.size()),
                            .observations = observations.data(),
                            .env = env.data(),
                            .task = task.data(),
                            .label = label.data(),
                            .taken = taken.data(),
                            .reward = reward.data()};
  std::vector<int> next;
  std::vector<float> planner_q;
  if (dump.meta("method") == "sf") {
    batch.next = (next = whole_numbers(dump, "next")).data();
    batch.planner_q = (planner_q = dump.get<float>("planner_q")).data();
  }
  const auto number = [&](const char* name) { return std::atof(dump.meta(name).c_str()); };
  // No input of a ReLU in the file is so near zero that a float's rounding changes its sign. Coarser products do change
  // some, and gradients with them: of those, only what stands before the gradients is compared.
  const bool coarse = kernels<float>().product_error > 0x1p-24;
  const double limit = coarse ? 10 * kernels<float>().product_error : 1e-4;
  const auto compare = [&](const std::string& kind, const std::string& name, const float* got) {
    const std::vector<float> want = dump.get<float>(name);
    worst.add(kind, name, relative_error(got, want.data(), want.size()), limit);
  };

  Parallel parallel(1);
  const Losses losses = net.step(
      parallel, batch, {{number("weight_reward"), number("weight_env"), number("weight_task")}, 0, number("discount")});
  const double got[5] = {losses.total, losses.policy, losses.reward, losses.env, losses.task};
  const std::vector<double> want = dump.get<double>("loss");
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(std::isnan(got[i]), std::isnan(want[i])) << i;
    if (!std::isnan(want[i]))
      worst.add("loss", "number " + std::to_string(i), relative_error(got + i, want.data() + i, 1), limit);
  }
  compare("logits", "logits", net.logits.data());
  if (const auto* synpo = dynamic_cast<const SynPo<float>*>(net.policy.get()))
    compare("psi", "psi", synpo->last_feature());
  if (coarse) return worst;
  for (const TensorInfo& tensor : layout.tensors())
    compare("gradient", "grad." + tensor.name, net.gradient.data() + tensor.offset);
  for (const TensorInfo& tensor : net.policy->statistics().tensors())
    compare("statistics", "after." + tensor.name, net.statistics.data() + tensor.offset);
  const std::vector<float> scores = net.infer(parallel, batch, SynPo<float>::kInferenceUnit);
  compare("inference", "eval_logits", scores.data());

  const std::vector<float> before = net.parameters;
  std::vector<float> m(net.parameters.size(), 0), v(net.parameters.size(), 0);
  AdamOptions adam;
  adam.learning_rate = number("learning_rate");
  adam.weight_decay = number("weight_decay");
  adam_step(parallel, adam, 1, layout.total(), net.gradient.data(), net.parameters.data(), m.data(), v.data());
  size_t moved = 0;
  for (const TensorInfo& tensor : layout.tensors()) {
    if (!dump.has("adam." + tensor.name)) continue;
    ++moved;
    compare("adam", "adam." + tensor.name, net.parameters.data() + tensor.offset);
    // The way that was gone, which is small beside where it leads: float parameters know it to some four digits.
    std::vector<float> way = dump.get<float>("adam." + tensor.name), gone(tensor.size);
    for (size_t i = 0; i < tensor.size; ++i) {
      way[i] -= before[tensor.offset + i];
      gone[i] = net.parameters[tensor.offset + i] - before[tensor.offset + i];
    }
    worst.add("adam's way", "adam." + tensor.name, relative_error(gone, way), 2e-3);
  }
  EXPECT_GE(moved, layout.tensors().size() / 2);
  return worst;
}

// Those of torch_reference.py's COMMITTED, and what SYNPO_TORCH_DUMP names besides, separated by colons: for instance
// dumps at full width.
std::vector<std::string> dumps() {
  std::vector<std::string> paths;
  for (const char* name : {"narrow", "general", "mtl", "mtl_general", "mlp", "modulenet", "sf_td", "sf_q", "sf_ce",
                           "temporal", "temporal_mlp"})
    paths.push_back(std::string("tests/data/torch_") + name + ".safetensors");
  const char* given = std::getenv("SYNPO_TORCH_DUMP");
  std::stringstream list(given ? given : "");
  for (std::string path; std::getline(list, path, ':');) paths.push_back(path);
  return paths;
}

class Torch : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Dump, Torch, testing::ValuesIn(dumps()),
                         [](const auto& info) { return std::filesystem::path(info.param).stem().string(); });

TEST_P(Torch, AgreesOnLossGradientsAndAdam) {
  for_every_target([](const std::string& target) {
    if (kernels<float>().product_error > 1e-3) return;  // of networks as narrow as these it leaves a digit at most
    const Worst worst = compare_with_dump(GetParam());
    if (!std::getenv("SYNPO_TORCH_DUMP")) return;
    std::printf("%s, %s\n", target.c_str(), GetParam().c_str());
    worst.print();
  });
}

}  // namespace
}  // namespace synpo
