// Operands that name files and label them.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "render/render.h"

using namespace synpo;

namespace {

struct NamedFile {
  std::string path, label;
  bool labelled;
};

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

std::vector<NamedFile> parse_operands(const std::vector<std::string>& operands) {
  std::vector<NamedFile> files;
  std::string label;
  bool labelled = false, waiting = false;  // by an operand LABEL=; for a file to follow it
  const auto add = [&](const std::string& path, bool has_label) {
    files.push_back({path, label, has_label});
    waiting = false;
  };
  const auto expect_none_waiting = [&] {
    if (waiting) fail(Exit::kUsage, "no file follows the label ", quoted(label + "="));
  };
  for (const std::string& operand : operands) {
    const size_t equals = operand.find('=');
    if (equals == std::string::npos || is_file(operand)) {
      add(operand, labelled);
      continue;
    }
    expect_none_waiting();
    label = operand.substr(0, equals);
    labelled = waiting = equals + 1 == operand.size();
    if (label.empty()) fail(Exit::kUsage, "the operand ", quoted(operand), " has no label before the =");
    if (labelled) continue;
    for (size_t begin = equals + 1; begin <= operand.size();) {
      size_t end = std::min(operand.find(',', begin), operand.size());
      if (is_file(operand.substr(begin))) end = operand.size();
      if (begin == end) fail(Exit::kUsage, "the operand ", quoted(operand), " names an empty file");
      add(operand.substr(begin, end - begin), true);
      begin = end + 1;
    }
  }
  expect_none_waiting();
  if (std::count_if(files.begin(), files.end(), [](const NamedFile& file) { return file.path == "-"; }) > 1)
    fail(Exit::kUsage, "standard input can be read only once");
  return files;
}

std::string stem(const NamedFile& file) {
  return file.path == "-" ? "standard input" : std::filesystem::path(file.path).stem().string();
}

// A file without a label has its own name, or its path where another file has that name as well; a file alone needs
// none.
void name_files(std::vector<NamedFile>& files) {
  const auto takes = [](const NamedFile& file, const std::string& name) {
    return (file.labelled ? file.label : stem(file)) == name;
  };
  for (NamedFile& file : files)
    if (!file.labelled && files.size() > 1) {
      const auto takers =
          std::count_if(files.begin(), files.end(), [&](const NamedFile& other) { return takes(other, stem(file)); });
      file.label = takers > 1 ? file.path : stem(file);
    }
}

}  // namespace

std::vector<LabelledFiles> labelled_files(std::vector<std::string> operands) {
  if (operands.empty()) operands = {"-"};
  std::vector<NamedFile> files = parse_operands(operands);
  name_files(files);
  std::vector<LabelledFiles> out;
  for (const NamedFile& file : files) {
    if (first_bad_byte(file.label) != std::string::npos)
      fail(Exit::kUsage, "the label ", quoted(file.label),
           " is not UTF-8 text without control characters: give another with LABEL=", quoted(file.path));
    if (file.label.size() > kLongestDrawn)
      fail(Exit::kUsage, "the label ", quoted(file.label), " has ", file.label.size(), " bytes, expected at most ",
           kLongestDrawn, ": give another with LABEL=", quoted(file.path));
    auto same =
        std::find_if(out.begin(), out.end(), [&](const LabelledFiles& other) { return other.label == file.label; });
    if (same == out.end()) same = out.insert(out.end(), {file.label, {}});
    same->paths.push_back(file.path);
  }
  return out;
}

const std::string& drawable(const std::string& text) {
  if (first_bad_byte(text) != std::string::npos) throw std::invalid_argument("expected UTF-8 text");
  if (text.size() > kLongestDrawn)
    throw std::invalid_argument(concat("expected at most ", kLongestDrawn, " bytes, not ", text.size()));
  return text;
}
