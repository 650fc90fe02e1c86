#include "learn/recipe.h"

#include <gtest/gtest.h>

#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Recipe, ValuesOfTheSupplement) {
  const ImitationOptions paper = recipe("paper");
  EXPECT_EQ(paper.trajectories, 64);
  EXPECT_EQ(paper.batch_states, 0);
  EXPECT_EQ(paper.memory, 20000);
  EXPECT_EQ(paper.learning_rate, 0.001);
  EXPECT_EQ(paper.weight_decay, 0.001);
  EXPECT_EQ(paper.reward_loss, 0.01);
  EXPECT_EQ(paper.env_loss, 0.1);
  EXPECT_EQ(paper.task_loss, 0.001);
  EXPECT_EQ(paper.network.normalise_input, true);
  EXPECT_EQ(paper.network.normalise_embeddings, false);
  EXPECT_EQ(thrown([] { recipe("slow"); }), "64 unknown recipe 'slow', expected fast or paper");
}

TEST(Recipe, LearningRateSchedule) {
  ImitationOptions options = recipe("paper");
  EXPECT_EQ(options.rate(0, 100), 0.001);
  EXPECT_EQ(options.rate(1000000, 100), 0.001);
  options.warm_up = 10;
  options.cosine = 1;
  options.final_rate = 0.0001;
  EXPECT_DOUBLE_EQ(options.rate(0, 110), 0.0001);
  EXPECT_DOUBLE_EQ(options.rate(9, 110), 0.001);
  EXPECT_DOUBLE_EQ(options.rate(10, 110), 0.001);
  EXPECT_DOUBLE_EQ(options.rate(60, 110), 0.00055);
  EXPECT_DOUBLE_EQ(options.rate(110, 110), 0.0001);
  EXPECT_DOUBLE_EQ(options.rate(5000, 110), 0.0001);
}

TEST(Recipe, BalanceMovesToItsEnd) {
  ImitationOptions options;
  options.balance = 0.1;
  EXPECT_EQ(options.running_options(50, 101).balance, 0.1);
  options.balance_final = 0.3;
  options.warm_up = 10;
  for (const int update : {0, 5, 10})
    EXPECT_DOUBLE_EQ(options.running_options(update, 110).balance, 0.1);  // whatever the total
  EXPECT_DOUBLE_EQ(options.running_options(60, 110).balance, 0.2);
  EXPECT_DOUBLE_EQ(options.running_options(110, 110).balance, 0.3);
  EXPECT_DOUBLE_EQ(options.running_options(5000, 110).balance, 0.3);
}

TEST(Recipe, ComesBackThroughTheCheckpoint) {
  ImitationOptions options = recipe("fast");
  options.learning_rate = 0.1 + 0.2;
  const std::map<std::string, std::string> values = describe_options(options);
  EXPECT_EQ(describe_options(parse_options(values)), values);
  EXPECT_EQ(parse_options(values).learning_rate, 0.1 + 0.2);
  const auto refused = [&](const char* name, const char* value) {
    std::map<std::string, std::string> changed = values;
    changed[name] = value;
    return thrown([&] { parse_options(changed); });
  };
  EXPECT_EQ(refused("roll-in", "1.5"), "65 option 'roll-in': found '1.5', expected a number from 0 to 1");
  EXPECT_EQ(refused("memory", "0"), "65 option 'memory': found '0', expected a whole number from 1 to 1e+07");
  EXPECT_EQ(refused("memory", "2.5"), "65 option 'memory': found '2.5', expected a whole number from 1 to 1e+07");
  EXPECT_EQ(refused("lr", "nan"), "65 option 'lr': found 'nan', expected a number from 0 to 1");
  EXPECT_EQ(refused("sf-loss", "mse"), "65 option 'sf-loss': found 'mse', expected td, q or ce");
  std::map<std::string, std::string> missing = values;
  missing.erase("lr");
  EXPECT_EQ(thrown([&] { parse_options(missing); }), "65 the checkpoint has no option 'lr'");
}

TEST(Recipe, CheckpointsFromBeforeAnOptionHaveItsDefault) {
  std::map<std::string, std::string> values = describe_options(recipe("fast"));
  for (const char* name : {"action-embedding", "head-hidden", "seam", "dropout", "sf-loss", "discount"})
    ASSERT_EQ(values.erase(name), 1u) << name;
  EXPECT_EQ(describe_options(parse_options(values)), describe_options(recipe("fast")));
  values["seam"] = "0";
  EXPECT_EQ(thrown([&] { parse_options(values); }),
            "65 option 'seam': found '0', expected a whole number from 1 to 4096");
}

TEST(Shape, CheckpointsFromBeforeASizeHaveItsDefault) {
  PolicyShape shape;
  shape.seam = 7;
  shape.sf_loss = SfLoss::kCrossEntropy;
  std::map<std::string, int64_t> sizes = describe_shape(shape);
  EXPECT_EQ(describe_shape(parse_shape(sizes)), sizes);
  for (const char* name : {"action_embedding", "head_hidden", "seam", "sf_loss"})
    ASSERT_EQ(sizes.erase(name), 1u) << name;
  EXPECT_EQ(describe_shape(parse_shape(sizes)), describe_shape(PolicyShape()));
  sizes["seam"] = 0;
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 shape 'seam': found 0, expected a whole number from 1 to 65536");
  sizes.erase("seam");
  sizes["sf_loss"] = 3;
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 shape 'sf_loss': found 3, expected a whole number from 0 to 2");
  sizes = describe_shape(shape);
  sizes.erase("basis");
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 the shape has no 'basis'");
}

TEST(Recipe, SomeValuesAreTheMethods) {
  for (const char* name : {"fast", "paper"}) {
    const ImitationOptions synpo = recipe(name);
    EXPECT_EQ(recipe(name, "mlp").network.feature, 256);
    EXPECT_EQ(recipe(name, "modulenet").network.head_hidden, 128);
    EXPECT_EQ(recipe(name, "sf").network.head_hidden, 512);
    EXPECT_EQ(describe_options(recipe(name, "mtl")), describe_options(synpo));
    EXPECT_EQ(synpo.reward_loss, 0.01);
  }
}

TEST(Recipe, FastHasWhatTheGridChoseForAMethodAndPaperHasNot) {
  EXPECT_EQ(recipe("paper", "sf").reward_loss, 1);
  EXPECT_EQ(recipe("paper", "sf").network.sf_loss, SfLoss::kTemporalDifference);
  EXPECT_EQ(recipe("fast", "sf").reward_loss, 0.01);
  EXPECT_EQ(recipe("fast", "sf").network.sf_loss, SfLoss::kCrossEntropy);
  EXPECT_EQ(recipe("fast", "modulenet").dropout, 0);
  EXPECT_EQ(recipe("fast", "mlp").embedding_sd, 0.3);
  for (const char* method : {"mlp", "modulenet", "sf"}) {
    EXPECT_EQ(recipe("paper", method).weight_decay, 0.001) << method;
    EXPECT_LT(recipe("fast", method).weight_decay, 0.001) << method;
  }
}

ImitationOptions from_command_line(std::vector<std::string> arguments, const std::string& method = "synpo") {
  RecipeOptions recipe_options;
  Options options("tool", "", "");
  recipe_options.add_to(options);
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  options.parse(int(argv.size()) - 1, argv.data());
  EXPECT_EQ(recipe_options.given(), arguments.size() > 1);
  return recipe_options.result(method);
}

TEST(Recipe, FromTheCommandLine) {
  EXPECT_EQ(describe_options(from_command_line({})), describe_options(recipe(kDefaultRecipe)));
  // The order of --recipe and what changes it does not matter.
  for (const auto& arguments : {std::vector<std::string>{"--recipe", "paper", "--task-loss", "0.5"},
                                {"--task-loss", "0.5", "--recipe", "paper"}}) {
    ImitationOptions want = recipe("paper");
    want.task_loss = 0.5;
    EXPECT_EQ(describe_options(from_command_line(arguments)), describe_options(want));
  }
  ImitationOptions want = recipe("fast", "sf");
  want.env_loss = want.task_loss = want.reward_loss = 0;
  want.network.sf_loss = SfLoss::kPlannerQ;
  EXPECT_EQ(describe_options(
                from_command_line({"--no-env-loss", "--no-task-loss", "--no-reward-loss", "--sf-loss", "q"}, "sf")),
            describe_options(want));
  EXPECT_EQ(thrown([] { from_command_line({"--sf-loss", "ce"}, "mlp"); }), "64 -m mlp has no --sf-loss");
  EXPECT_EQ(thrown([] { from_command_line({"--dropout", "0.1"}); }), "64 -m synpo has no --dropout");
  EXPECT_EQ(from_command_line({"--action-embedding", "3"}, "mtl").network.action_embedding, 3);
  EXPECT_EQ(thrown([] {
              from_command_line({"--sf-loss", "0"});
            }),
            "64 option --sf-loss: found '0', expected td, q or ce; try 'tool --help'");
  EXPECT_EQ(thrown([] {
              from_command_line({"--recipe", "paper", "--roll-in", "0.5"});
            }),
            "64 --roll-in needs --batch-states");
  EXPECT_EQ(thrown([] {
              from_command_line({"--recipe", "slow"});
            }),
            "64 option --recipe: found 'slow', expected fast or paper; try 'tool --help'");
  EXPECT_EQ(thrown([] {
              from_command_line({"--balance", "0"});
            }),
            "64 option --balance: found '0', expected a number from 0.001 to 1; try 'tool --help'");
}

}  // namespace
}  // namespace synpo
