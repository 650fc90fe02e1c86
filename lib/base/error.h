// The one error type of the library, and the exit codes that the tools return (sysexits.h).
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

namespace synpo {

enum class Exit { kOk = 0, kUsage = 64, kData = 65, kNoInput = 66, kInternal = 70, kCantCreate = 73, kIo = 74 };

// A failure with a message fit for the user. The library throws it and never prints or exits.
class Error : public std::runtime_error {
 public:
  Error(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Exit code() const { return code_; }

 private:
  Exit code_;
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

// `text` between single quotes, cut at 60 bytes, with control characters and invalid UTF-8 written as \xNN.
// For naming foreign input in a message.
std::string quoted(const std::string& text);

}  // namespace synpo
