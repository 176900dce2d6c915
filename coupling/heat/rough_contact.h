#pragma once

namespace granrad {

/// The surface of rough spheres, and the gas in the gaps of the joint.
struct RoughSurface {
  double microhardness_Pa = 0;      ///< H, of the softer body
  double roughness_m = 0;           ///< sigma, root mean square of one surface
  double slope = 0;                 ///< m, mean absolute slope of the asperities of one surface
  double accommodation = 0.9;       ///< thermal accommodation coefficient of gas and surface, (0, 1]
  double mean_free_path_m = 68e-9;  ///< of the gas: air at 20 degC and 1 bar
};

/// Conductance of the solid contact of two rough spheres, W/K: the constriction into the contact disc, in series
/// with the joint across it, where asperities and the gas between them conduct side by side,
///   1/G = 1/(2 k a) + 1/((h_c + h_g) pi a^2),   h_c = 1.25 k (m/sigma) (p/H)^0.95,   p = F / (pi a^2),
///   h_g = k_g / (Y + M),   Y = 1.53 sigma (p/H)^-0.097,   M = 2 (2 - alpha)/alpha 2 gamma/(1 + gamma) Lambda / Pr,
/// with sigma and m of both surfaces together (sqrt 2 of one), gamma = 1.4, Pr = 0.71 (Cooper, Mikic and Yovanovich,
/// Int. J. Heat Mass Transfer 12 (1969) 279; Yovanovich, 1982). 2 k a is Batchelor's; it is 1/sqrt(pi) of the paper's
/// 2 k sqrt(A).
/// The flow's softened spheres carry the true load F on too large a disc: F = 4/3 E_soft a_soft^3 / R, so that the
/// real disc has a = a_soft (E_soft/E_real)^(1/3) (beds at rest). `force_N` and `radius_m` (a) are the real ones.
/// gas_W_mK = 0: no gas.
double rough_contact_conductance(const RoughSurface& surface, double conductivity_W_mK, double gas_W_mK,
                                 double force_N, double contact_radius_m);

/// Hertz: the load that presses two bodies of reduced radius `radius_m` to a disc of radius a, N.
double hertz_force_N(double modulus_Pa, double radius_m, double contact_radius_m);

}  // namespace granrad
