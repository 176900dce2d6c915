#pragma once
#include <array>

#include "dem/bed/wall.h"

namespace granrad {

/// Closed forms and quadratures of unobstructed diffuse view factors: the truths that tracers are judged by.

/// View factor from a sphere of radius r1 to one of radius r2, centres s apart:
///   F12 = 1 / (2 pi r1^2)  integral_0^thetaM  sin(theta) Lens(r1, r2, s sin(theta)) dtheta,
/// sin(thetaM) = min(1, (r1 + r2) / s), Lens(a, b, d) = common area of two discs d apart. Equal and touching:
/// 0.0755868184216. Gauss-Legendre after a substitution that removes the end-point roots; error below
/// 1e-10 (1e-9 at a ratio of the radii of 100), about 1 microsecond. Preconditions: r1, r2, s > 0. Overlapping, a ray that
/// starts inside the other sphere is a hit on it: a line through both discs then counts where it leaves the other sphere last,
/// and by the symmetry of equal spheres half of the two directions of all such lines do, so that the formula holds. Unequal
/// ones are read as touching.
double exact_two_sphere(double r1, double r2, double s);

/// View factor from a sphere to a planar wall that does not cut it: solid angle at the centre / 4 pi,
/// whatever the radius. Zero from behind the wall.
double exact_sphere_wall(const Vec3& centre, const Wall& wall);

/// Directly opposed parallel rectangles a x b, c apart (Howell's catalogue C-11).
double exact_parallel_rectangles(double a, double b, double c);

/// Perpendicular rectangles with a common edge `length`: from the one of width `from` to the one of width
/// `to` (Howell's catalogue C-14).
double exact_perpendicular_rectangles(double length, double from, double to);

/// Factors between the walls of an empty box, [from][to], in the order x_min .. z_max.
std::array<std::array<double, 6>, 6> exact_empty_box(const Box& box);

}  // namespace granrad
