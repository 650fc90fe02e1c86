// The tools say this about failures of the library, where an option of theirs helps.
#pragma once
#include <string>

#include "base/cli/options.h"
#include "base/error.h"
#include "engine/torch_engine.h"
#include "format/trajectory.h"
#include "learn/finite.h"
#include "play/episode.h"
#include "play/model.h"
#include "play/stream.h"
#include "play/world_factory.h"

namespace synpo {

constexpr Advice kSeeWorld = {kOtherWorld, "{} (other maps? see -w)"};
constexpr Advice kNameFolder = {kNoSource, "{}: name their folder with -w kitchen:DIR"};
constexpr Advice kNameOtherFolder = {kOtherSource, "{}, expected -w kitchen:DIR"};
constexpr Advice kLeaveWorld = {kNeedsNoSource, "{}: -w may name the same, or those that lie in files of their own"};
constexpr Advice kBuildPlugin = {kNoPlugin, "{}: make torch builds it (synpo(7))"};
constexpr Advice kWriteEnd = {kNoEnd, "{} (synpo-gen-expert --end writes one: was the stream cut off?)"};
constexpr Advice kSmallerRate = {kNotFinite, "{}: try a smaller --lr"};

inline std::string words(const TestedStart& start) {
  return concat(start.file, ": line ", start.line, " begins where episode ", start.episode, " of synpo-eval -s ",
                start.seed, " begins: success measured with that seed will be of starts that were learned from",
                " (synpo-eval --starts training records others)");
}

}  // namespace synpo
