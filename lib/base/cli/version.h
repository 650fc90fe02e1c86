// What this build is called.
#pragma once
#include <string>

namespace synpo {

extern const char kVersion[];  // "0.2.0"
extern const char kCommit[];   // "abc1234", or "abc1234, modified" where the sources are not the commit's; may be empty

// "0.2.0 (git abc1234)".
std::string version_text();

}  // namespace synpo
