// Temporaries under way, which must not outlive the process. Their owners remove them; where a signal ends the process,
// its handler does.
#pragma once
#include <string>

namespace synpo {

// While it lives, `path` is removed should a signal end the process: a file, or a folder with the files in it.
class Leftover {
 public:
  enum class Kind { kFile, kFolder };
  Leftover(const std::string& path, Kind kind);
  ~Leftover();
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

 private:
  int slot_;  // -1 where there was no room for it
};

// Removes all of them. Calls nothing that a signal handler may not call.
void remove_leftovers();

}  // namespace synpo
