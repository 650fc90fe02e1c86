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

// What a line may not be broken within: what stands in brackets, where it fits into a line, "< FILE", and a dash with
// what is before it.
std::vector<std::string> unbroken_parts(const std::string& line, size_t room) {
  std::vector<std::string> parts;
  const auto add = [&](const std::string& part) {
    if (part.empty()) return;
    const bool joined = !parts.empty() && (part[0] == '-' || parts.back() == "<" || parts.back() == ">");
    if (joined)
      parts.back() += ' ' + part;
    else
      parts.push_back(part);
  };
  for (size_t begin = 0; begin < line.size();) {
    const size_t word_end = std::min(line.find(' ', begin), line.size());
    size_t end = begin;
    int depth = 0;
    for (; end < line.size() && (line[end] != ' ' || depth > 0); ++end)
      depth += line[end] == '[' ? 1 : line[end] == ']' ? -1 : 0;
    if (end - begin > room) end = word_end;
    add(line.substr(begin, end - begin));
    begin = end + 1;
  }
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
    for (const std::string& part : unbroken_parts(text.substr(begin, end - begin), width - std::min(width, indent))) {
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
