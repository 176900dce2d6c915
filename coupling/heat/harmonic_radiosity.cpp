#include "coupling/heat/harmonic_radiosity.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstMap = Eigen::Map<const Matrix>;

/// to_i += K from_j and to_j += K^T from_i for one block.
template <int n, int m>
void add_block(const double* k, const double* from_i, const double* from_j, double* to_i, double* to_j) {
  for (int a = 0; a < n; ++a) {
    double sum = 0;
    for (int b = 0; b < m; ++b) {
      sum += k[a * m + b] * from_j[b];
      to_j[b] += k[a * m + b] * from_i[a];
    }
    to_i[a] += sum;
  }
}

/// The same for a block of one column: a sphere and a patch.
void add_column(int n, const double* k, const double* from_i, double from_j, double* to_i, double& to_j) {
  double sum = 0;
  for (int a = 0; a < n; ++a) {
    to_i[a] += k[a] * from_j;
    sum += k[a] * from_i[a];
  }
  to_j += sum;
}

class System {
 public:
  System(const ExchangeMoments& moments, const std::vector<double>& power,
         const std::vector<double>& emissivity)
      : m_(moments) {
    const auto base = *std::min_element(power.begin(), power.end());
    for (std::int32_t e = 0; e < m_.element_count(); ++e) {
      const auto s = m_.surface[e];
      power_.push_back(power[s] - base);
      reflects_.push_back(ends_on(e) > 0 ? 1 - emissivity[s] : 0);
      emits_.push_back(emissivity[s]);
      inverse_.emplace_back();
      if (reflects_[e] == 0) continue;
      inverse_.back().compute(Eigen::MatrixXd(ConstMap(mass(e), m_.size(e), m_.size(e)) / reflects_[e]));
      if (inverse_.back().info() != Eigen::Success)
        throw InputError(
            advised(fmt::format("radiation.order: surface {} is met by too few lines for its moments", s),
                    "raise rays"));
    }
  }

  std::vector<double> heat(std::size_t surfaces) const {
    const Vector b = solve();
    std::vector<double> heat(surfaces, 0);
    for (const auto& block : m_.blocks) {
      const ConstMap k(m_.values.data() + block.at, m_.size(block.i), m_.size(block.j));
      const double received = (k.row(0).dot(part(b, block.j)) - k.col(0).dot(part(b, block.i))) * m_.unit_m2;
      heat[m_.surface[block.i]] += received;
      heat[m_.surface[block.j]] -= received;
    }
    return heat;
  }

 private:
  const double* mass(std::int32_t e) const { return m_.mass.data() + m_.mass_at[e]; }
  double ends_on(std::int32_t e) const { return *mass(e); }
  Eigen::VectorBlock<const Vector> part(const Vector& v, std::int32_t e) const {
    return v.segment(m_.first[e], m_.size(e));
  }

  /// to_i += sum_j K_ij from_j, both ways.
  void add_exchange(const Vector& from, Vector& to) const {
    for (const auto& block : m_.blocks) {
      const double* k = m_.values.data() + block.at;
      const auto i = m_.first[block.i], j = m_.first[block.j];
      const int n = m_.size(block.i), m = m_.size(block.j);
      if (n == 1)
        add_block<1, 1>(k, &from[i], &from[j], &to[i], &to[j]);  // patches come after spheres
      else if (m == 1)
        add_column(n, k, &from[i], from[j], &to[i], to[j]);
      else if (n == 4)
        add_block<4, 4>(k, &from[i], &from[j], &to[i], &to[j]);
      else if (n == 9)
        add_block<9, 9>(k, &from[i], &from[j], &to[i], &to[j]);
      else
        add_block<16, 16>(k, &from[i], &from[j], &to[i], &to[j]);
    }
  }

  /// use(e, M_e) of each surface that reflects.
  template <class Use>
  void for_reflecting(Use use) const {
    for (std::int32_t e = 0; e < m_.element_count(); ++e)
      if (reflects_[e] != 0) use(e, ConstMap(mass(e), m_.size(e), m_.size(e)));
  }

  /// M / rho x - K x on the surfaces that reflect, zero elsewhere.
  Vector apply(const Vector& x) const {
    Vector exchanged = Vector::Zero(x.size()), y = Vector::Zero(x.size());
    add_exchange(x, exchanged);
    for_reflecting([&](std::int32_t e, const ConstMap& mass_matrix) {
      y.segment(m_.first[e], m_.size(e)) = mass_matrix * part(x, e) / reflects_[e] - part(exchanged, e);
    });
    return y;
  }

  Vector preconditioned(const Vector& r) const {
    Vector z = Vector::Zero(r.size());
    for (std::int32_t e = 0; e < m_.element_count(); ++e)
      if (reflects_[e] > 0) z.segment(m_.first[e], m_.size(e)) = inverse_[e].solve(part(r, e));
    return z;
  }

  Vector right_side(const Vector& known) const {
    Vector from_black = Vector::Zero(known.size()), rhs = Vector::Zero(known.size());
    add_exchange(known, from_black);
    for_reflecting([&](std::int32_t e, const ConstMap& mass_matrix) {
      rhs.segment(m_.first[e], m_.size(e)) =
          emits_[e] / reflects_[e] * power_[e] * mass_matrix.col(0) + part(from_black, e);
    });
    return rhs;
  }

  /// Coefficients of all elements.
  Vector solve() const {
    constexpr double tolerance = 1e-9;
    constexpr int most_iterations = 2000;
    Vector b = Vector::Zero(m_.first.back());
    for (std::int32_t e = 0; e < m_.element_count(); ++e)
      if (reflects_[e] == 0) b[m_.first[e]] = power_[e];
    const Vector rhs = right_side(b);
    const double goal = tolerance * rhs.norm();
    Vector x = Vector::Zero(b.size()), r = rhs, z = preconditioned(r), p = z;
    double rz = r.dot(z);
    int iteration = 0;
    for (; r.norm() > goal && iteration < most_iterations; ++iteration) {
      const Vector q = apply(p);
      const double alpha = rz / p.dot(q);
      x += alpha * p, r -= alpha * q;
      z = preconditioned(r);
      const double next = r.dot(z);
      p = z + (next / rz) * p;
      rz = next;
    }
    if (!(r.norm() <= goal))
      throw NumericalError(advised(
          fmt::format("radiosities of higher order: residual {:.2e} of the emission after {} iterations",
                      r.norm() / rhs.norm(), iteration),
          "try source = \"paths\""));
    return b + x;
  }

  const ExchangeMoments& m_;
  std::vector<double> power_, reflects_, emits_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> inverse_;
};

}  // namespace

std::vector<double> solve_harmonic_radiosity(const ExchangeMoments& moments,
                                             const std::vector<double>& emissive_power_W_m2,
                                             const std::vector<double>& emissivity) {
  return System(moments, emissive_power_W_m2, emissivity).heat(emissivity.size());
}

}  // namespace granrad
