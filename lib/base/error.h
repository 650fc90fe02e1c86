// The one error type of the library, and the exit codes that the tools return (sysexits.h).
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace synpo {

enum class Exit {
  kOk = 0,
  kUsage = 64,
  kData = 65,
  kNoInput = 66,
  kUnavailable = 69,
  kInternal = 70,
  kCantCreate = 73,
  kIo = 74
};

// Names what went wrong, for failures against which the user of a tool can do something that the library cannot name:
// options are the tool's. A constant beside the function that fails with it; the tool's Advice (cli/options.h) adds the
// words.
struct Cause {
  const char* name = "";
};

// A failure with a message fit for the user. The library throws it and never prints or exits.
class Error : public std::runtime_error {
 public:
  Error(Exit code, const std::string& message, Cause cause = {})
      : std::runtime_error(message), code_(code), cause_(cause) {}
  Exit code() const { return code_; }
  bool has(Cause cause) const { return std::string(cause_.name) == cause.name; }
  // The same, with the place in front of its message.
  Error at(const std::string& place) const { return {code_, place + what(), cause_}; }

 private:
  Exit code_;
  Cause cause_;
};

// The arguments, written one after the other.
template <class... Args>
std::string concat(const Args&... args) {
  std::ostringstream out;
  (out << ... << args);
  return out.str();
}

template <class... Args>
[[noreturn]] void fail(Exit code, const Args&... args) {
  throw Error(code, concat(args...));
}
template <class... Args>
[[noreturn]] void fail(Exit code, Cause cause, const Args&... args) {
  throw Error(code, concat(args...), cause);
}

// `text` with control characters, marks of direction and invalid UTF-8 written as \xNN, cut at `limit` bytes: foreign
// input that is shown.
std::string printable(std::string_view text, size_t limit = std::string_view::npos);

// `text` between single quotes, cut at 60 bytes, made printable(), and with what shows as nothing or as another kind of
// blank written as \xNN too: found and expected never look alike.
// For naming foreign input in a message.
std::string quoted(const std::string& text);

// The character at `at`, for a message: "'x'"; by its name or number where it cannot be seen: "a tab", "a no-break
// space", "a byte order mark", "U+200B", "the byte \xff".
std::string character_text(std::string_view text, size_t at);

}  // namespace synpo
