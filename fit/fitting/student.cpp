#include "fit/fitting/student.h"

#include <boost/math/distributions/students_t.hpp>

namespace granrad {

double student_widening(std::size_t n) {
  constexpr double normal_quantile = 1.959963984540054;
  return boost::math::quantile(boost::math::students_t(static_cast<double>(n) - 1), 0.975) / normal_quantile;
}

}  // namespace granrad
