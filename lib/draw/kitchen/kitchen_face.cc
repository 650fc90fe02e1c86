#include "draw/kitchen/kitchen_face.h"

#include "base/error.h"
#include "base/text.h"
#include "draw/face/episode_words.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/kitchen/kitchen_picture.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/rules.h"

namespace synpo {

const FaceKind KitchenFace::kKind = {.environment = "kitchen",
                                     .environments = "kitchens",
                                     .task_hint = "an object and a receptacle, such as Mug-Sink",
                                     .has_window = false,
                                     .has_text = false,
                                     .has_policy_picture = false};

KitchenFace::KitchenFace(const std::shared_ptr<const KitchenSet>& world) : WorldFace(world), set_(*world) {
  for (const Environment& env : set_.environments())
    kitchens_.push_back(parse_kitchen(env.name, env.content, env.name));
}

KitchenFrame KitchenFace::frame(const Film& film, int moment) const {
  return set_.frame(film.pair.env, film.states[size_t(moment)]);
}

KitchenEvent KitchenFace::event(const Film& film, int i) const {
  const KitchenState before = unpack(film.states[size_t(i)]), after = unpack(film.states[size_t(i) + 1]);
  for (int door = 0; door < kKitchenDoors; ++door)
    if ((before.doors ^ after.doors) >> door & 1)
      return {after.doors >> door & 1 ? Deed::kOpened : Deed::kClosed, door};
  if (before.hand == after.hand) return {};
  if (before.hand == kEmptyHand) return {Deed::kPicked, after.hand};
  return {Deed::kPut, receptacle_in_reach(set_.tables(film.pair.env), before.pose, before.doors)};
}

std::string KitchenFace::outcome(const Film& film) const {
  if (!film.results.back().wrong) return WorldFace::outcome(film);
  return event(film, film.steps() - 1).deed == Deed::kPicked ? "wrong object" : "wrong receptacle";
}

std::string KitchenFace::deeds(const Film& film) const {
  std::string words;
  int without_effect = 0;
  for (int i = 0; i < film.steps(); ++i) {
    const auto add = [&](const char* name, const char* what) {
      words += concat(words.empty() ? "; " : ", ", name, what, " at step ", i + 1);
    };
    const KitchenEvent done = event(film, i);
    switch (done.deed) {
      case Deed::kNone:
        without_effect += film.results[size_t(i)].reward_cents == kStepCents + kInvalidCents;
        break;
      case Deed::kOpened:
        add(kKitchenReceptacleNames[done.thing], " opened");
        break;
      case Deed::kClosed:
        add(kKitchenReceptacleNames[done.thing], " closed");
        break;
      case Deed::kPicked:
        add(kKitchenObjectNames[done.thing], "");
        break;
      case Deed::kPut:
        add(kKitchenReceptacleNames[done.thing], " filled");
        break;
    }
  }
  if (words.empty()) words = "; nothing picked up";
  if (without_effect > 0) words += "; " + counted(without_effect, "step") + " without effect";
  return words;
}

std::string KitchenFace::action_words(const Film& film, int i) const {
  const KitchenEvent done = event(film, i);
  switch (done.deed) {
    case Deed::kOpened:
      return concat("open ", kKitchenReceptacleNames[done.thing]);
    case Deed::kClosed:
      return concat("close ", kKitchenReceptacleNames[done.thing]);
    case Deed::kPicked:
      return concat("pick ", kKitchenObjectNames[done.thing]);
    case Deed::kPut:
      return concat("put in ", kKitchenReceptacleNames[done.thing]);
    default:
      return WorldFace::action_words(film, i);
  }
}

PlanSize KitchenFace::plan_size(int env) const { return {kitchens_[size_t(env)].rows, kitchens_[size_t(env)].columns}; }

int KitchenFace::agent_cell(int env, const WorldState& state) const {
  const KitchenPose eye = set_.frame(env, state).eye;
  return plan_cell(kitchens_[size_t(env)], eye.row, eye.column);
}

Canvas KitchenFace::draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const {
  std::vector<Kitchen> chosen;
  for (const int env : envs) chosen.push_back(kitchens_[size_t(env)]);
  return draw_kitchens(chosen, style, font);
}

// In the characters of the plan; floor is blank.
BlockPlan KitchenFace::block_plan(int env) const {
  const Kitchen& kitchen = kitchens_[size_t(env)];
  return {kitchen.name, kitchen.rows, kitchen.columns, [&kitchen](int row, int column) {
            const char c = kitchen.at(row, column);
            const bool lettered = std::string(kKitchenReceptacleLetters).find(c) != std::string::npos;
            return Block{kitchen_cell_colour(c, paper_floor(kitchen.hash)[0]), lettered ? c : ' ', c == '.' ? ' ' : c};
          }};
}

}  // namespace synpo
