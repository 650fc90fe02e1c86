// The commands of synpo-finetune.
#pragma once
#include <string>

#include "base/io.h"
#include "format/checkpoint.h"

int adapt(int argc, char** argv);
int ppo(int argc, char** argv);

inline synpo::Checkpoint load_checkpoint(const std::string& path) {
  synpo::Input input(path);
  return synpo::read_checkpoint(input);
}
