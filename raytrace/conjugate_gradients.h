#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

namespace granrad {

/// x of A x = right by conjugate gradients from x = 0, A symmetric and positive definite, `image(y)` = A y. Ends when
/// |right - A x| <= enough |right|, after `most_steps`, or where A is found not to be positive (Golub and Van Loan,
/// Matrix Computations, 11.3).
template <class Image>
std::vector<double> conjugate_gradients(std::vector<double> right, double enough, int most_steps,
                                        Image image) {
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  std::vector<double> x(right.size(), 0), left = std::move(right), search = left;
  double square = dot(left, left);
  const double goal = enough * enough * square;
  for (int step = 0; step < most_steps && square > goal; ++step) {
    const std::vector<double> along = image(search);
    const double curvature = dot(search, along);
    if (!(curvature > 0)) break;
    const double length = square / curvature;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += length * search[i], left[i] -= length * along[i];
    const double now = dot(left, left);
    for (std::size_t i = 0; i < x.size(); ++i) search[i] = left[i] + now / square * search[i];
    square = now;
  }
  return x;
}

}  // namespace granrad
