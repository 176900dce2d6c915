// Local solid fractions: a bed that fills its box counts as uniform, one that fills part of it does not, and then
// each place has what is around it.
#include "fit/correlation/solid_fraction_field.h"

#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "dem/packing/packing.h"
#include "tests/packed_beds.h"

namespace granrad {
namespace {

Enclosure packed(const Box& box, const Box& filled, double phi) {
  return packed_bed(box, filled, phi, 0.5);
}

// Planted error: windows of 5 d at every solid fraction -> deviations of 0.47 at 0.02 and 0.22 at 0.07.
TEST(SolidFractionField, TakesAFilledBoxAsUniform) {
  const Box box{{0, 0, 0}, {12.5, 5, 30}};
  for (const double phi : {0.02, 0.07, 0.25, 0.43, 0.5}) {
    const SolidFractionField field(packed(box, box, phi), phi);
    EXPECT_TRUE(field.uniform()) << phi << " " << field.deviation();
    EXPECT_LT(field.deviation(), 0.12) << phi;
    EXPECT_EQ(field.at({6, 2, 15}), phi);
  }
}

TEST(SolidFractionField, KnowsTheBedFromTheVoidAboveIt) {
  const Box box{{0, 0, 0}, {12.5, 5, 30}};
  const auto bed = packed(box, {{0, 0, 0}, {12.5, 5, 12}}, 0.45);
  const SolidFractionField field(bed, solid_fraction(bed));
  EXPECT_NEAR(field.whole(), 0.45 * 12 / 30, 1e-3);
  EXPECT_FALSE(field.uniform());
  EXPECT_NEAR(field.at({6, 2.5, 5}), 0.45, 0.05);
  EXPECT_LT(field.at({6, 2.5, 25}), 1e-3);
  EXPECT_NEAR(field.between({6, 2.5, 5}, {6, 2.5, 29}), 0.45 * 7 / 24, 0.05);
  EXPECT_GT(field.mean_at_spheres(), 0.35);
}

// Spheres across the faces of a region count with the part inside; without a region, by the walls.
TEST(SolidFractionField, MeasuresTheWholeByTheRegion) {
  Bed bed;
  bed.materials.emplace_back();
  bed.box = {{0, 0, 0}, {1, 1, 2}};
  for (auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.walls[5].contact = false;
  bed.add({0.5, 0.5, 2}, {}, 0.25, 300);  // half of it is inside; the wall z_max is moved to clear it
  const auto enclosure = make_enclosure(bed, bed.box);
  EXPECT_NEAR(solid_fraction(enclosure), 0.5 * 4 * M_PI / 3 * 0.25 * 0.25 * 0.25 / 2, 1e-12);
}

}  // namespace
}  // namespace granrad
