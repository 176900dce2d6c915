#pragma once
#include <array>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// Volume of the part of a sphere that lies inside a box, m^3, in closed form: by inclusion and exclusion of
/// the eight octants {x >= a, y >= b, z >= c}; that of one octant is a third of its spherical area (the
/// theorem of Gauss and Bonnet on circles of latitude) less a third of each flat face times its distance from
/// the centre (the divergence theorem). Within 1e-14 of the sphere.
double sphere_volume_in_box_m3(const Vec3& centre_m, double radius_m, const Box& box);

/// Solid fraction of a region, the one definition of this project: volume of the spheres *inside* the region
/// / volume of the region. A sphere across a face counts with the part inside, wherever its centre is.
/// `period`: where periodic, the box the spheres repeat with; their images count. 0 for a region of no volume.
/// Spheres that overlap each other are counted twice in the lens they share.
double solid_fraction(const std::vector<Vec3>& centre_m, const std::vector<double>& radius_m,
                      const Box& region, const std::array<bool, 3>& periodic = {}, const Box& period = {});
double solid_fraction(const Bed& bed, const Box& region);

}  // namespace granrad
