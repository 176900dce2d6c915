#pragma once
#include <cstddef>

namespace granrad {

/// Student's (Biometrika 6 (1908) 1) quantile t(0.975; n - 1)
/// over that of the normal distribution: what a standard error from n values
/// is multiplied by so that +- 1.96 of it cover 95 %. Precondition: n >= 2.
double student_widening(std::size_t n);

}  // namespace granrad
