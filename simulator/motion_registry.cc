#include "simulator/motion_registry.h"

#include "simulator/motions/motions.h"

namespace rcme {

const std::vector<MotionEntry>& MotionRegistry() {
  static const std::vector<MotionEntry> registry = {
      {"general", "rotation about any axis up to a bound, translation in any direction", MakeGeneralMotion},
      {"forward", "driving: along the optical axis, give or take a few degrees", MakeForwardMotion},
      {"sideways", "across the optical axis, left or right, give or take a few degrees", MakeSidewaysMotion},
      {"orbit", "around a point in front of the camera, looking at it all the time", MakeOrbit},
      {"ackermann", "planar: a circular arc on flat ground, one yaw angle gives rotation and direction",
       MakeAckermann},
      {"pure_rotation", "no translation (Type A): the direction is not defined and not scored",
       MakePureRotation},
      {"vanishing_baseline", "as general, with a baseline close to zero", MakeVanishingBaseline},
      {"hand_held", "a camera in the hand: turns mostly sideways, moves mostly across the view",
       MakeHandHeld},
      {"vehicle", "a camera in a car: the arc of ackermann with pitch, roll and slip", MakeVehicle},
  };
  return registry;
}

}  // namespace rcme
