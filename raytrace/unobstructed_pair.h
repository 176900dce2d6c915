#pragma once

namespace granrad {

/// exact_two_sphere for equal spheres at d* = centre distance / d, from a table of F d*^2 against 1/d* (4096
/// intervals to contact, linear): relative error below 1e-6, some nanoseconds. d* < 0.5 counts as 0.5.
double unobstructed_pair(double d_star);

}  // namespace granrad
