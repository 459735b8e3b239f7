// The kinds of buildings and what stands between them. Each stands at the builder's site, front
// towards -y, within width x depth metres. Their floors and feet lie below the ground, and bodies
// that belong together run into each other: no two faces lie on each other.
#pragma once

#include "generate/model_builder.h"
#include "generate/random.h"

namespace crease {

// One or two floors, gable or hip roof, a chimney.
void add_house(ModelBuilder& b, Random& random, double width, double depth);
// No windows: what fills a garden, or the rest of a triangle budget.
void add_shed(ModelBuilder& b, Random& random, double width, double depth);
// Narrow, the gable to the street, two to four floors.
void add_town_house(ModelBuilder& b, Random& random, double width, double depth);
// Three to five floors with shops and balconies; mansard, hip, vaulted or flat roof.
void add_apartments(ModelBuilder& b, Random& random, double width, double depth);
// The same behind a row of arches with a terrace on it.
void add_arcade_house(ModelBuilder& b, Random& random, double width, double depth);
// Ten floors and more, set back at the top.
void add_office_tower(ModelBuilder& b, Random& random, double width, double depth);
// A round building of several drums under a dome or a cone.
void add_round_tower(ModelBuilder& b, Random& random, double width, double depth);
// Barrel-vaulted bays behind arched gates.
void add_hall(ModelBuilder& b, Random& random, double width, double depth);
void add_water_tower(ModelBuilder& b, Random& random, double width, double depth);
void add_factory_chimney(ModelBuilder& b, Random& random, double width, double depth);
// A nave under a gable roof, a tower with a spire, an apse.
void add_church(ModelBuilder& b, Random& random, double width, double depth);
// A portico in front, a dome on a drum above.
void add_town_hall(ModelBuilder& b, Random& random, double width, double depth);
// Columns around, an entablature, a dome.
void add_rotunda(ModelBuilder& b, Random& random, double width, double depth);
// A row of arches with a walk on top.
void add_arcade(ModelBuilder& b, Random& random, double width, double depth);
// A column with a figure on it, on steps.
void add_monument(ModelBuilder& b, Random& random, double width, double depth);
// A round basin with two bowls.
void add_fountain(ModelBuilder& b, Random& random, double width, double depth);
// Across a river along y, `depth` from bank to bank; a road on arches, at the site's height.
void add_bridge(ModelBuilder& b, Random& random, double width, double depth);

// A cathedral inside a ring of walls, 130 m across, around the site's origin.
void add_landmark(ModelBuilder& b, Random& random);

}  // namespace crease
