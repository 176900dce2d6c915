#pragma once

namespace granrad {

/// Solid-fluid-solid conductance in units of k_gas R: integral of 2 pi r / max(l, s) over the lens, l the gap
/// at radius r, lengths in units of R (paper Eq. sfs and Appendix B). The printed closed form has three
/// misprints: its d >= 0 branch is the particle pair (prefactor pi), its d < 0 branch the wall (2 pi); r_out
/// of the pair must divide by 4 R^2 d^2 (as printed: NaN at contact); s is the half gap in the pair and the
/// full gap at the wall. Checked against 40-digit quadrature, data/reference/sfs_exact.csv: 28.1515707342
/// (pair) and 56.2581158722 (wall) at contact for d = 0.8 mm.

/// Two equal spheres. overlap: half the overlap / R (< 0: half the gap); gap: half the minimum gap / R.
double pair_lens(double half_overlap, double half_minimum_gap, double lens_ratio);

/// Sphere and plane. overlap: overlap / R (< 0: gap); minimum gap / R.
double wall_lens(double overlap, double minimum_gap, double lens_ratio);

/// Two spheres of any radii, in units of k_gas (so in m): over the disc inside both particles' lenses, each
/// of lens_ratio times its own radius. Closed: with l as variable, r dr = (y/4 - D^2/(4 y^3)) dl, y =
/// distance - l, D = r1^2 - r2^2. Equals R pair_lens for equal radii.
double lens_m(double radius_i_m, double radius_j_m, double distance_m, double minimum_gap_m,
              double lens_ratio);

}  // namespace granrad
