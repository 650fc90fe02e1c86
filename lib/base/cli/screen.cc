#include "base/cli/screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "base/text.h"

namespace synpo {
namespace {

int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  int value = 0;
  return text && parse_whole(text, value) && value > 0 ? value : 0;
}

// What a line may not be broken within.
std::vector<std::string> unbroken_parts(const std::string& line) {
  std::vector<std::string> parts;
  int depth = 0;
  std::string part;
  const auto end_part = [&] {
    // "< FILE" is one part, and so is what comes before a dash.
    const bool joined = !parts.empty() && (part[0] == '-' || parts.back() == "<" || parts.back() == ">");
    if (joined)
      parts.back() += ' ' + part;
    else
      parts.push_back(part);
    part.clear();
  };
  for (const char c : line) {
    if (c == ' ' && depth == 0) {
      if (!part.empty()) end_part();
      continue;
    }
    depth += c == '[' ? 1 : c == ']' && depth > 0 ? -1 : 0;
    part += c;
  }
  if (!part.empty()) end_part();
  return parts;
}

}  // namespace

ScreenSize screen_size(int fd) {
  if (!isatty(fd)) return {};
  winsize size{};
  if (ioctl(fd, TIOCGWINSZ, &size) != 0) size = {};
  return {size.ws_col > 0 ? size.ws_col : number_of("COLUMNS"), size.ws_row > 0 ? size.ws_row : number_of("LINES")};
}

std::string wrapped(const std::string& text, size_t used, size_t indent, size_t width) {
  std::string out;
  size_t column = used;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (begin > 0) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    }
    bool first = true;
    for (const std::string& part : unbroken_parts(text.substr(begin, end - begin))) {
      if (!first && column + 1 + part.size() > width) {
        out += '\n' + std::string(indent, ' ');
        column = indent;
      } else if (!first) {
        out += ' ';
        ++column;
      }
      out += part;
      column += part.size();
      first = false;
    }
    begin = end + 1;
  }
  return out;
}

std::string shell_quoted(const std::string& word) {
  static const std::string harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%^";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace synpo
