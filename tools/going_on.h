// What a tool says of a run that was stopped: the command that goes on from its checkpoint.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/screen.h"
#include "base/files/descriptor.h"
#include "learn/long_run.h"

namespace synpo {

// How the stream of a run came: `reads` is whether it has one, `files` are those that were named, none for standard
// input.
struct StreamOfRun {
  bool reads;
  std::vector<std::string> files;
};

// Says it on stderr where there is a checkpoint to go on from. `not_again` are the options that the checkpoint takes
// the place of.
inline void tell_how_to_go_on(const char* tool, const LongRun& settings, const Options& options,
                              std::vector<std::string> not_again, const StreamOfRun& stream) {
  if (settings.save.empty() || settings.quiet) return;
  not_again.emplace_back("resume");
  std::string command = options.given_again(not_again) + " --resume " + shell_quoted(settings.save);
  for (const std::string& file : stream.files) command += " " + shell_quoted(file);
  const bool from_stdin = stream.reads && stream.files.empty();
  const std::string in = from_stdin ? file_of_descriptor(0) : "",
                    out = settings.output == "-" ? file_of_descriptor(1) : "";
  if (!in.empty()) command += " < " + shell_quoted(in);
  if (!out.empty()) command += " > " + shell_quoted(out);
  std::fprintf(stderr, "%s: this goes on%s: %s\n", tool,
               from_stdin && in.empty() ? ", with the same stream on standard input" : "", command.c_str());
}

}  // namespace synpo
