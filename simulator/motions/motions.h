// The motions that motion_registry lists, one file each.
#pragma once

#include <memory>

#include "simulator/motion_model.h"

namespace rcme {

// Rotation about a uniform axis, translation in a uniform direction.
std::unique_ptr<MotionModel> MakeGeneralMotion();
// The same with a baseline close to zero.
std::unique_ptr<MotionModel> MakeVanishingBaseline();
// Along the optical axis, or across it, within a cone of a few degrees.
std::unique_ptr<MotionModel> MakeForwardMotion();
std::unique_ptr<MotionModel> MakeSidewaysMotion();
// Around a point in front of camera 1; both cameras look at it.
std::unique_ptr<MotionModel> MakeOrbit();
// A car on a flat road: a circular arc, whose yaw angle also determines the direction.
std::unique_ptr<MotionModel> MakeAckermann();
// No translation at all (Type A): the direction is not defined.
std::unique_ptr<MotionModel> MakePureRotation();
// A hand-held camera; a camera in a car on a real road: arc, pitch, roll.
std::unique_ptr<MotionModel> MakeHandHeld();
std::unique_ptr<MotionModel> MakeVehicle();

}  // namespace rcme
