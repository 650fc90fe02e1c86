// An output beside the one that the work is for.
#pragma once
#include <exception>
#include <functional>
#include <string>
#include <string_view>

#include "base/files/io.h"

namespace synpo {

// What goes wrong with it, a reader that went away included, does not cost the work: the rest is not written, and
// check(), at the end of the work, throws.
class SideOutput {
 public:
  explicit SideOutput(const std::string& path) : output_(path, Output::Kind::kStream) {}
  void write(std::string_view bytes);
  void finish();
  void check() const;

 private:
  void attempt(const std::function<void()>& act);
  Output output_;
  std::exception_ptr failure_;
};

}  // namespace synpo
