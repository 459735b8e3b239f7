// What stands on a block between four streets.
#pragma once

#include "generate/model_builder.h"
#include "generate/random.h"

#include <vector>

namespace crease {

using AddBuilding = void (*)(ModelBuilder&, Random&, double width, double depth);

struct BuildingKind {
  const char* name;
  AddBuilding add;
};

struct Lot {
  BuildingKind kind;
  Vec3d corner;           // front left, from the block's middle
  int quarter_turns = 0;  // 0: the front looks towards -y
  double width = 0, depth = 0;
  bool turned = false;  // by the angle of the 3-4-5 triangle besides
};

enum class Zone { OldTown, Downtown, Middle, Outer, Works };

struct BlockPlan {
  bool green = false;
  std::vector<Lot> lots;
};

BlockPlan plan_block(Random& random, Zone zone, double width, double depth);
// The ring of squares around the landmark, which takes the middle half_width x half_depth.
std::vector<Lot> plan_close(double half_width, double half_depth);

extern const BuildingKind kHouse, kShed, kBridge, kTrees;

}  // namespace crease
