// Colours for print of plans, whatever their world. What the agent sees has its own.
#pragma once
#include "base/rgb.h"

namespace synpo {

constexpr Rgb kPaperWall = {62, 70, 82}, kPaperFloor = {250, 249, 245}, kPaperGrid = {226, 224, 217},
              kPaperAgent = {20, 20, 24};
constexpr Rgb kPaperWrong = {200, 0, 0};  // around what ended an episode and should not have

}  // namespace synpo
