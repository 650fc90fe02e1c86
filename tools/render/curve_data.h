// What the logs given to synpo-render curves hold of what is to be drawn.
#pragma once
#include <string>
#include <vector>

#include "draw/plot/curves.h"
#include "format/run_log.h"
#include "render/render.h"

// The meaning of -y: the log's columns, one for each part, and the axis.
struct Measure {
  std::vector<std::string> columns, parts;
  std::string title;
  bool percent;
  // The column of a training's own episodes that may be drawn where nothing was evaluated; "": none.
  std::string own = "";
  bool of_training = false;  // of the episodes that a training played
};

// Of a column's name, or of success or reward over pairs that are seen, unseen, both or training: those that the
// training itself played.
Measure find_measure(const std::string& name, const std::string& pairs);

struct CurveRequest {
  std::vector<LabelledFiles> logs;
  synpo::RunLogAxis axis;
  double unit = 1;  // of a value on the axis across
  std::string name;
  Measure measure;
  bool any = false;      // where nothing was evaluated, the loss of the policy will do
  bool growing = false;  // a row at the end may be being written
};

struct CurveData {
  std::vector<synpo::MethodRuns> methods;
  Measure measure;   // what they are of
  std::string note;  // says that this is not what was asked for; may be empty
};

// Throws kData, with the place, for what is no log, or has no value that could be drawn.
CurveData read_curve_data(const CurveRequest& request);
