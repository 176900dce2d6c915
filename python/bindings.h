#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <vector>

#include "dem/bed/bed.h"

// The compiled part of the Python package, one function for each group of names.
void bind_errors(pybind11::module_& module);
void bind_exchange(pybind11::module_& module);
void bind_scenes(pybind11::module_& module);
void bind_correlations(pybind11::module_& module);

/// A float64 array of any layout.
using NumberArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A copy of `values` as an array [n].
template <class T>
pybind11::array_t<T> array_of(const std::vector<T>& values) {
  return pybind11::array_t<T>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

/// An array [n, 3].
inline pybind11::array_t<double> array_of_vectors(const std::vector<granrad::Vec3>& values) {
  pybind11::array_t<double> out({static_cast<pybind11::ssize_t>(values.size()), pybind11::ssize_t{3}});
  auto at = out.mutable_unchecked<2>();
  for (pybind11::ssize_t i = 0; i < at.shape(0); ++i)
    for (int axis = 0; axis < 3; ++axis) at(i, axis) = values[static_cast<std::size_t>(i)][axis];
  return out;
}

/// Of an array [n, 3]; throws InputError naming `what` for another shape.
std::vector<granrad::Vec3> vectors_of(const NumberArray& array, const char* what);
/// Of an array [n] or one number for all; throws InputError for another length.
std::vector<double> numbers_of(const NumberArray& array, std::size_t count, const char* what);
