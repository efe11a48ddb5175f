#include "simulator/motion_registry.h"

#include "simulator/motions/motions.h"

namespace rcme {

const std::vector<MotionEntry>& MotionRegistry() {
  static const std::vector<MotionEntry> registry = {
      {"general", "rotation about any axis, translation in any direction", MakeGeneralMotion},
      {"forward", "along the optical axis, within a few degrees", MakeForwardMotion},
      {"sideways", "left or right, within a few degrees", MakeSidewaysMotion},
      {"orbit", "around a point in front of the camera, towards which it looks", MakeOrbit},
      {"ackermann", "circular arc on flat ground: yaw gives rotation and direction", MakeAckermann},
      {"pure_rotation", "no translation (Type A); no direction is scored", MakePureRotation},
      {"vanishing_baseline", "as general, with little parallax", MakeVanishingBaseline},
      {"hand_held", "turns mostly sideways, moves mostly across the view", MakeHandHeld},
      {"vehicle", "ackermann with pitch, roll and slip", MakeVehicle},
  };
  return registry;
}

}  // namespace rcme
