#include "fuzz.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace synpo::fuzz {
namespace {

// Its end is where the bytes end, and it is read from the beginning.
int filled(std::string_view bytes) {
  static const int fd = memory_file("input");
  require(ftruncate(fd, 0) == 0 && lseek(fd, 0, SEEK_SET) == 0 && write_all(fd, bytes) && lseek(fd, 0, SEEK_SET) == 0,
          "the input is written");
  return fd;
}

constexpr uint64_t kMostBytes = 1 << 18;  // of tensors

// Where the last tensor of a header ends; 0 where it says nothing of the kind.
size_t end_of_tensors(std::string_view header) {
  const nlohmann::json json = nlohmann::json::parse(header, nullptr, false);
  if (!json.is_object()) return 0;
  uint64_t end = 0;
  for (const auto& entry : json) {
    if (!entry.is_object()) continue;
    const auto offsets = entry.find("data_offsets");
    if (offsets == entry.end() || !offsets->is_array() || offsets->size() != 2) continue;
    if ((*offsets)[1].is_number_unsigned()) end = std::max(end, (*offsets)[1].get<uint64_t>());
  }
  return size_t(std::min(end, kMostBytes));
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: expected that %s\n", what);
  std::abort();
}

Bytes::Bytes(std::string_view bytes) : input_(filled(bytes), "bytes") {}

std::string with_tensors(std::string_view input) {
  const size_t line = std::min(input.find('\n'), input.size());
  const std::string_view header = input.substr(0, line), bytes = input.substr(std::min(line + 1, input.size()));
  std::string file;
  for (int byte = 0; byte < 8; ++byte) file += char(uint64_t(header.size()) >> (8 * byte));
  file += header;
  const size_t end = file.size() + end_of_tensors(header);
  file += bytes;
  if (file.size() < end) file.resize(end);
  return file;
}

int memory_file(const char* name) {
  const int fd = memfd_create(name, MFD_CLOEXEC);
  require(fd >= 0, "there is a file in memory");
  return fd;
}

std::string take_contents(int fd) {
  struct stat status;
  require(fstat(fd, &status) == 0, "the output can be looked at");
  std::string bytes(size_t(status.st_size), '\0');
  require(pread(fd, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()), "the output can be read");
  require(ftruncate(fd, 0) == 0 && lseek(fd, 0, SEEK_SET) == 0, "the output can be emptied");
  return bytes;
}

}  // namespace synpo::fuzz
