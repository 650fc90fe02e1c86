// The worlds that are drawn, by their names, and the face of each. A world with a face of its own has a row in
// faces.cc.
#pragma once
#include <memory>
#include <string>

#include "draw/face/world_face.h"
#include "world/world.h"

namespace synpo {

// The face of the world of this name on the command line. Throws kUsage for a world that cannot be drawn, kData and
// kNoInput for what is wrong with its files.
std::unique_ptr<const WorldFace> open_face(const std::string& world);

// The face of a world that is there already: its own, or WorldFace, which draws it in words.
std::unique_ptr<const WorldFace> face_of(std::shared_ptr<const World> world);

// "gridworld, gridworld:DIR or kitchen"
std::string drawn_worlds();
// The worlds whose faces have this, and their environments: "gridworld", "mazes".
std::string worlds_with(bool FaceKind::*feature);
std::string environments_with(bool FaceKind::*feature);

}  // namespace synpo
