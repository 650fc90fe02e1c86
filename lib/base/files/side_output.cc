#include "base/files/side_output.h"

namespace synpo {

void SideOutput::write(std::string_view bytes) {
  attempt([&] { output_.write(bytes); });
}

void SideOutput::finish() {
  attempt([&] { output_.finish(); });
}

void SideOutput::check() const {
  if (failure_) std::rethrow_exception(failure_);
}

void SideOutput::attempt(const std::function<void()>& act) {
  if (failure_) return;
  try {
    act();
  } catch (...) {
    failure_ = std::current_exception();
  }
}

}  // namespace synpo
