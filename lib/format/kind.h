// What a file is, as far as its beginning tells: for messages about a file of another kind than was expected.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace synpo {

enum class FileKind { kUnknown, kCheckpoint, kTrajectories, kTable, kPicture };

// Of a checkpoint the first eight bytes are enough.
inline FileKind kind_of(std::string_view beginning) {
  using namespace std::string_view_literals;
  if (beginning.starts_with("\x89PNG"sv)) return FileKind::kPicture;
  if (beginning.starts_with('{')) return FileKind::kTrajectories;
  // No header is longer than four bytes tell: the upper half of its length is zeros.
  if (beginning.size() >= 8 && beginning.substr(4, 4) == "\0\0\0\0"sv && beginning.substr(8, 1) != "\0"sv)
    return FileKind::kCheckpoint;
  const std::string_view line = beginning.substr(0, beginning.find('\n'));
  const bool printable =
      std::all_of(line.begin(), line.end(), [](unsigned char c) { return c == '\t' || (c >= ' ' && c < 127); });
  return printable && line.find('\t') != line.npos ? FileKind::kTable : FileKind::kUnknown;
}

// " (this is a checkpoint)", say; nothing where the beginning tells nothing, or what was expected.
inline std::string another_kind(std::string_view beginning, FileKind expected) {
  const FileKind kind = kind_of(beginning);
  if (kind == expected) return "";
  switch (kind) {
    case FileKind::kCheckpoint:
      return " (this is a checkpoint)";
    case FileKind::kTrajectories:
      return " (this is JSON, as trajectories are)";
    case FileKind::kTable:
      return " (this is a table)";
    case FileKind::kPicture:
      return " (this is a picture)";
    case FileKind::kUnknown:
      break;
  }
  return "";
}

}  // namespace synpo
