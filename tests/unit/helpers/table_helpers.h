// Text in and out of the table readers and writers, through files as the tools do it.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "base/error.h"
#include "base/files/io.h"
#include "helpers/temporary.h"

namespace synpo {

// In a folder of this process alone, which is gone at its end.
inline std::string temporary_path() {
  static const TemporaryFolder folder;
  return folder.file("table.tsv");
}

// The result of `read` for a file that holds `text`.
template <class Read>
auto read_text(const std::string& text, Read read) {
  const std::string path = temporary_path();
  std::ofstream(path, std::ios::binary) << text;
  struct Remove {
    std::string path;
    ~Remove() { unlink(path.c_str()); }
  } remove{path};
  Input input(path);
  return read(input);
}

// The text that `write` writes.
inline std::string written(const std::function<void(Output&)>& write) {
  const std::string path = temporary_path();
  Output output(path);
  write(output);
  output.finish();
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  unlink(path.c_str());
  return text;
}

// "65 IN: line 2: ..." for what `work` throws, with IN in place of the temporary's name; "nothing thrown" otherwise.
inline std::string thrown(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    std::string message = error.what();
    const std::string path = temporary_path();
    for (size_t at; (at = message.find(path)) != std::string::npos;) message.replace(at, path.size(), "IN");
    return std::to_string(int(error.code())) + " " + message;
  }
  return "nothing thrown";
}

// The message of what `work` throws, which is wrong data; "no error" otherwise.
inline std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::kData);
    return error.what();
  }
  return "no error";
}

// Whether it fails, and for this cause.
inline bool fails_for(Cause cause, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.has(cause);
  }
  return false;
}

}  // namespace synpo
