#include "learn/imitate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/cpu_engine.h"
#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

// Small but for the convolutions, which have no option.
ImitationOptions small_options() {
  ImitationOptions options;
  options.network.feature = 8;
  options.network.basis = 6;
  options.network.embedding = 5;
  options.network.hidden = 12;
  options.memory = 7;
  options.fill = 4;
  options.read = 2;
  options.learning_rate = 0.003;
  return options;
}

ImitationOptions whole_trajectories() {
  ImitationOptions options = small_options();
  options.trajectories = 2;
  options.network.normalise_input = true;
  return options;
}

ImitationOptions single_steps() {
  ImitationOptions options = small_options();
  options.batch_states = 45;
  options.running = 64;
  options.balance = 0.3;
  options.roll_in = 0.5;
  options.roll_noise = 0.2;
  options.fresh_starts = 1;
  options.roll_limit = 50;
  options.cosine = 1;
  options.warm_up = 2;
  options.averaging = 0.99;
  options.network.normalise_embeddings = 1;
  return options;
}

const std::vector<EnvTask> kSeen = {{0, 0}, {1, 5}, {7, 19}};

// A stream over text, with the run that reads it.
struct Session {
  explicit Session(const std::string& text) : path(folder.file("stream", text)), input(path) {}
  void start(const ImitationOptions& options, int threads, const std::vector<EnvTask>& seen = kSeen,
             uint64_t seed = 3) {
    parallel = std::make_unique<Parallel>(threads);
    run = std::make_unique<Imitation>(builtin_world(), *parallel, "synpo", options, seen, seed);
    run->set_total_updates(8);
    stream = std::make_unique<TrajectoryStream>(input, builtin_world(), run->allowed(), run->window());
  }
  void resume(const std::string& checkpoint, int threads) {
    parallel = std::make_unique<Parallel>(threads);
    run = std::make_unique<Imitation>(builtin_world(), *parallel,
                                      read_text(checkpoint, [](Input& in) { return read_checkpoint(in); }));
    stream = std::make_unique<TrajectoryStream>(input, builtin_world(), run->allowed(), run->window());
    stream->skip(run->stream_lines(), run->stream_hash());
  }
  void update(int count) {
    for (int i = 0; i < count; ++i) ASSERT_TRUE(run->update(*stream));
  }
  std::string saved(bool all = true) const { return format_checkpoint(run->checkpoint(all)); }
  TemporaryFolder folder;
  std::string path;
  Input input;
  std::unique_ptr<Parallel> parallel;
  std::unique_ptr<Imitation> run;
  std::unique_ptr<TrajectoryStream> stream;
};

class ImitationModes : public testing::TestWithParam<ImitationOptions (*)()> {
 protected:
  ImitationOptions options() const { return GetParam()(); }
};

TEST_P(ImitationModes, StoppedAndResumedIsUnbroken) {
  // The stream ends on the way: 4 trajectories at first, then 2 an update.
  const std::string lines = expert_lines(kSeen, 13, 0.2);
  std::string halfway, end;
  {
    Session unbroken(lines);
    unbroken.start(options(), 2);
    unbroken.update(3);
    halfway = unbroken.saved();
    unbroken.update(4);
    EXPECT_TRUE(unbroken.stream->ended());
    end = unbroken.saved();
  }
  {
    Session resumed(lines);
    resumed.resume(halfway, 1);
    EXPECT_EQ(resumed.run->updates(), 3);
    EXPECT_EQ(resumed.run->stream_lines(), 8u);
    EXPECT_TRUE(resumed.saved() == halfway);
    resumed.update(4);
    EXPECT_TRUE(resumed.saved() == end) << "bytes differ";
  }
  EXPECT_FALSE(halfway == end);
}

TEST_P(ImitationModes, ThreadsAndPausesDoNotShow) {
  const std::string lines = expert_lines(kSeen, 10);
  std::string results[3];
  for (const int threads : {1, 2}) {
    Session session(lines);
    session.start(options(), threads);
    session.update(2);
    if (threads == 2) {
      // Neither reports nor evaluations nor checkpoints change what is learned.
      session.run->take_report();
      session.run->evaluate_sample(2);
      session.saved();
    }
    session.update(2);
    results[threads] = session.saved();
  }
  EXPECT_TRUE(results[1] == results[2]) << "bytes differ";
}

TEST_P(ImitationModes, StrippedAndWholeCheckpointsHaveTheSameWeights) {
  Session session(expert_lines(kSeen, 10));
  session.start(options(), 2);
  session.update(3);
  const Checkpoint whole = session.run->checkpoint(true);
  Checkpoint stripped = whole;
  stripped.strip();
  EXPECT_TRUE(format_checkpoint(stripped) == session.saved(false));
  EXPECT_EQ(whole.weights_hash(), stripped.weights_hash());
  EXPECT_LT(stripped.file.tensors.size(), whole.file.tensors.size());
  EXPECT_EQ(whole.updates, 3);
  EXPECT_EQ(whole.seed, 3u);
  EXPECT_EQ(whole.window, 1);
  EXPECT_EQ(whole.seen,
            (std::vector<std::pair<std::string, std::string>>{{"map1", "R-B"}, {"map2", "R-G"}, {"map8", "P-O"}}));
  EXPECT_EQ(parse_options(whole.options).learning_rate, 0.003);
  EXPECT_EQ(thrown([&] { Imitation(builtin_world(), *session.parallel, stripped); }),
            "65 the checkpoint has no training state (was it stripped?)");
  EXPECT_TRUE(fails_for(kNoTrainingState, [&] { Imitation(builtin_world(), *session.parallel, stripped); }));
}

// Computes an update as late as it may: when its results are asked for.
class LateEngine : public CpuEngine {
 public:
  using CpuEngine::CpuEngine;
  void begin_update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                    const AdamUpdate& adam, float* logits) override {
    const size_t n = size_t(batch.size);
    observations_.assign(batch.observations, batch.observations + n * observation_size);
    env_.assign(batch.env, batch.env + n);
    task_.assign(batch.task, batch.task + n);
    label_.assign(batch.label, batch.label + n);
    taken_.assign(batch.taken, batch.taken + n);
    reward_.assign(batch.reward, batch.reward + n);
    StepBatch<float> kept = batch;
    kept.observations = observations_.data();
    kept.env = env_.data();
    kept.task = task_.data();
    kept.label = label_.data();
    kept.taken = taken_.data();
    kept.reward = reward_.data();
    EXPECT_FALSE(late_) << "an update begins before the last one has ended";
    late_ = [this, &parallel, kept, options, adam, logits] {
      CpuEngine::begin_update(parallel, kept, options, adam, logits);
    };
  }
  Losses end_update() override {
    std::exchange(late_, nullptr)();
    return CpuEngine::end_update();
  }
  void give_back() override { EXPECT_FALSE(late_) << "an update is lost"; }
  bool computes() const { return bool(late_); }

  size_t observation_size = 0;

 private:
  std::vector<uint8_t> observations_;
  std::vector<int> env_, task_, label_, taken_;
  std::vector<float> reward_;
  std::function<void()> late_;
};

TEST_P(ImitationModes, AnUpdateThatEndsAfterTheNextDrawShowsNowhere) {
  for (const double roll_in : {0.0, 0.5}) {
    ImitationOptions options = this->options();
    if (options.batch_states > 0) options.roll_in = roll_in;
    const std::string lines = expert_lines(kSeen, 12);
    std::string results[2];
    RunLogRow rows[2];
    bool overlapped = false;
    for (const bool late : {false, true}) {
      Session session(lines);
      session.start(options, 2);
      LateEngine* engine = nullptr;
      if (late)
        session.run->compute_with([&](Policy<float>& policy) {
          auto made = std::make_unique<LateEngine>(policy);
          engine = made.get();
          engine->observation_size = policy.observation_size();
          return made;
        });
      session.update(2);
      if (late) overlapped = engine->computes();
      session.run->evaluate_sample(2);
      session.update(1);
      session.saved();
      session.update(2);
      rows[late] = session.run->take_report();
      results[late] = session.saved();
    }
    EXPECT_TRUE(results[0] == results[1]) << "bytes differ";
    EXPECT_EQ(rows[0].loss, rows[1].loss);
    EXPECT_EQ(rows[0].right[0], rows[1].right[0]);
    EXPECT_EQ(overlapped, options.roll_in == 0) << "the learner's own moves alone have to be waited for";
  }
}

std::string mode_name(const testing::TestParamInfo<ImitationOptions (*)()>& info) {
  return info.index ? "SingleSteps" : "WholeTrajectories";
}
INSTANTIATE_TEST_SUITE_P(Modes, ImitationModes, testing::Values(&whole_trajectories, &single_steps), mode_name);

TEST(Imitation, LearnsItsOwnFewSteps) {
  Session session(expert_lines({{0, 0}}, 2));
  ImitationOptions options = whole_trajectories();
  options.memory = 2;
  options.trajectories = 1;
  session.start(options, 2, {{0, 0}});
  session.run->set_total_updates(60);
  session.update(3);
  const RunLogRow first = session.run->take_report();
  EXPECT_EQ(first.update, 3);
  EXPECT_EQ(first.trajectories, 2);
  EXPECT_NEAR(first.loss, first.policy + 0.01 * first.reward + 0.1 * first.env + 0.001 * first.task, 1e-5);
  EXPECT_EQ(first.learning_rate, 0.003);
  session.update(50);
  session.run->take_report();
  session.update(4);
  const RunLogRow last = session.run->take_report();
  EXPECT_LT(last.policy, 0.3 * first.policy);
  EXPECT_GT(last.right[0], 0.8);
  EXPECT_GT(last.states, first.states);
}

TEST(Imitation, AveragedWeightsFollow) {
  ImitationOptions options = single_steps();
  Session session(expert_lines(kSeen, 10));
  session.start(options, 2);
  session.update(4);
  const Checkpoint checkpoint = session.run->checkpoint(true);
  const std::vector<float> averaged = checkpoint.file.get<float>("theta"),
                           raw = checkpoint.file.get<float>("train/raw/theta");
  EXPECT_NE(averaged, raw);
  options.averaging = 0;
  Session plain(expert_lines(kSeen, 10));
  plain.start(options, 2);
  plain.update(4);
  EXPECT_EQ(plain.run->checkpoint(true).file.get<float>("theta"), raw);
  EXPECT_FALSE(plain.run->checkpoint(true).file.has("train/raw/theta"));
}

TEST(Imitation, TakesTheWeightsOfAnotherModel) {
  Session trained(expert_lines(kSeen, 10));
  trained.start(whole_trajectories(), 2);
  trained.update(2);
  const Checkpoint checkpoint = trained.run->checkpoint(false);
  const Model model = load_model(checkpoint, builtin_world());
  Imitation fresh(builtin_world(), *trained.parallel, "synpo", whole_trajectories(), {}, 9);
  EXPECT_NE(fresh.checkpoint(false).weights_hash(), checkpoint.weights_hash());
  fresh.take_weights(model);
  EXPECT_EQ(fresh.checkpoint(false).weights_hash(), checkpoint.weights_hash());
  EXPECT_EQ(fresh.updates(), 0);
  ImitationOptions wider = whole_trajectories();
  wider.network.hidden = 13;
  Imitation other(builtin_world(), *trained.parallel, "synpo", wider, {}, 9);
  EXPECT_EQ(thrown([&] { other.take_weights(model); }),
            "65 the checkpoint's network is not the one asked for: method or sizes differ");
}

TEST(Imitation, SeenPairsAreGivenOrGrow) {
  Session given(expert_lines({{0, 0}}, 6));
  given.start(whole_trajectories(), 1);
  given.update(1);
  EXPECT_EQ(given.run->model().seen, kSeen);
  EXPECT_EQ(given.run->allowed(), kSeen);

  Session grown(expert_lines({{2, 2}, {0, 1}}, 3) + expert_lines({{4, 4}}, 3));
  grown.start(whole_trajectories(), 1, {});
  grown.update(1);
  EXPECT_EQ(grown.run->model().seen, (std::vector<EnvTask>{{2, 2}, {0, 1}, {4, 4}}));
  EXPECT_TRUE(grown.run->allowed().empty());
  // And do so when the run goes on.
  const std::string checkpoint = grown.saved();
  Session resumed(contents(grown.path));
  resumed.resume(checkpoint, 1);
  EXPECT_TRUE(resumed.run->allowed().empty());
}

TEST(Imitation, AnEmptyStreamTeachesNothing) {
  Session session("");
  session.start(whole_trajectories(), 1);
  EXPECT_FALSE(session.run->update(*session.stream));
  EXPECT_EQ(session.run->updates(), 0);
}

TEST(Imitation, ErrorsOfTheStreamNameTheLine) {
  const std::string good = expert_lines(kSeen, 5);
  const auto refused = [](const std::string& text) {
    Session session(text);
    session.start(whole_trajectories(), 1);
    std::string message = thrown([&] {
      for (int i = 0; i < 3; ++i) session.run->update(*session.stream);
    });
    if (const size_t at = message.find(session.path); at != std::string::npos)
      message.replace(at, session.path.size(), "IN");
    return message;
  };
  EXPECT_EQ(refused(good), "nothing thrown");
  EXPECT_EQ(refused(good + expert_lines({{3, 3}}, 1)), "65 IN: line 6: pair map4, O-P is not in the seen set");
  EXPECT_EQ(refused(good + expert_lines({{0, 0}}, 1, 0, 0)),
            "65 IN: line 6: window 0, expected 1 as in the trajectories before");
  EXPECT_EQ(refused(good + "[]\n"), "65 IN: line 6: found '[]', expected a JSON object");
}

TEST(Imitation, ResumingOnAnotherStreamIsRefused) {
  Session first(expert_lines(kSeen, 12));
  first.start(whole_trajectories(), 1);
  first.update(2);
  const std::string checkpoint = first.saved();
  Session other(expert_lines(kSeen, 12, 0.1));
  EXPECT_TRUE(thrown([&] {
                other.resume(checkpoint, 1);
              }).ends_with(": the first 6 lines are not those that the checkpoint was trained on"));
}

// As programs wrote it whose numbers without a sign were U64.
TEST(Imitation, GoesOnFromUnsignedNumbersToTheSameBits) {
  const auto ended = [](bool as_before) {
    Session first(expert_lines(kSeen, 12)), second(expert_lines(kSeen, 12));
    first.start(single_steps(), 2);
    first.update(2);
    Checkpoint checkpoint = first.run->checkpoint(true);
    for (const char* name : {"train/position", "train/memory/serials", "train/memory/added"}) {
      EXPECT_EQ(checkpoint.file.tensors.at(name).type, TensorType::kI64) << name;
      if (as_before) checkpoint.file.tensors.at(name).type = TensorType::kU64;
    }
    const auto is_unsigned = [](const auto& entry) { return entry.second.type == TensorType::kU64; };
    EXPECT_EQ(std::ranges::count_if(checkpoint.file.tensors, is_unsigned), as_before ? 3 : 0);
    second.resume(format_checkpoint(checkpoint), 2);
    second.update(2);
    return second.saved();
  };
  EXPECT_TRUE(ended(true) == ended(false));
}

TEST(Imitation, RefusesDamagedTrainingState) {
  Session session(expert_lines(kSeen, 12));
  session.start(single_steps(), 2);
  session.update(2);
  const Checkpoint good = session.run->checkpoint(true);
  const auto refused = [&](const std::function<void(Checkpoint&)>& change) {
    Checkpoint checkpoint = good;
    change(checkpoint);
    return thrown([&] { Imitation(builtin_world(), *session.parallel, checkpoint); });
  };
  for (const char* name :
       {"train/m/theta", "train/v/theta", "train/raw/theta", "train/memory/episodes", "train/running/running"})
    EXPECT_EQ(refused([&](Checkpoint& c) { c.file.tensors.erase(name); }), concat("65 no tensor '", name, "'"));
  EXPECT_EQ(refused([](Checkpoint& c) { c.options["hidden"] = "13"; }),
            "65 the checkpoint's shape and options disagree");
  EXPECT_EQ(refused([](Checkpoint& c) { c.options.erase("lr"); }), "65 the checkpoint has no option 'lr'");
  const uint64_t position[3] = {1, 2, 3};
  EXPECT_EQ(refused([&](Checkpoint& c) { c.file.add("train/position", {3}, position, 3); }),
            "65 tensor 'train/position': found 3 values, expected 4");
}

TEST(Imitation, EvaluatesSampledPairs) {
  Session session(expert_lines(kSeen, 10));
  session.start(whole_trajectories(), 2);
  session.update(1);
  const RunLogRow::Evaluation once = session.run->evaluate_sample(4), again = session.run->evaluate_sample(4);
  EXPECT_EQ(once.seen_reward, again.seen_reward);
  EXPECT_EQ(once.unseen_reward, again.unseen_reward);
  EXPECT_TRUE(once.seen_success >= 0 && once.seen_success <= 1);
  EXPECT_LT(once.unseen_reward, 12);
  EXPECT_GT(once.unseen_reward, -11);
  std::vector<EnvTask> all;
  for (int env = 0; env < 20; ++env)
    for (int task = 0; task < 20; ++task) all.push_back({env, task});
  Session full(expert_lines(kSeen, 10));
  full.start(whole_trajectories(), 2, all);
  full.update(1);
  const RunLogRow::Evaluation none = full.run->evaluate_sample(2);
  EXPECT_TRUE(std::isnan(none.unseen_success) && std::isnan(none.unseen_reward));
  EXPECT_FALSE(std::isnan(none.seen_success));
}

TEST(Imitation, UnseenPairsAreOfEnvironmentsAndTasksThatWereSeen) {
  const std::vector<EnvTask> block = {{3, 0}, {3, 1}, {5, 0}, {5, 1}}, corner = {{3, 0}, {3, 1}, {5, 0}};
  for (const auto& seen : {block, corner}) {
    Session session(expert_lines(seen, 10));
    session.start(whole_trajectories(), 2, seen);
    session.update(1);
    EXPECT_EQ(std::isnan(session.run->evaluate_sample(2).unseen_success), seen == block);
  }
}

}  // namespace
}  // namespace synpo
