#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/base/vec3.h"

namespace granrad {

/// Arrays for numpy.load: a zip archive, not compressed, of one .npy file (format 1.0) for each array. Equal content gives
/// equal bytes: no clock is in it. The arrays are not copied and must outlive `write`.
class NpzWriter {
 public:
  /// One-dimensional.
  void add(const std::string& name, const std::vector<double>& values);
  void add(const std::string& name, const std::vector<std::int64_t>& values);
  void add(const std::string& name, const std::vector<std::int32_t>& values);
  /// [n, 3] f64.
  void add(const std::string& name, const std::vector<Vec3>& values);
  /// [n] bytes of fixed length, as numpy's S type (`.astype(str)`).
  void add(const std::string& name, const std::vector<std::string>& texts);
  /// A single number or text.
  void add_scalar(const std::string& name, double value);
  void add_scalar(const std::string& name, std::int64_t value);
  void add_scalar(const std::string& name, const std::string& text);

  /// Writes to a temporary name beside `file`, fsyncs and renames. Creates the folder. Throws IoError.
  void write(const std::filesystem::path& file) const;

 private:
  struct Array {
    std::string name, header;
    const void* data = nullptr;  ///< where `own` is empty
    std::size_t bytes = 0;
    std::string own;
  };
  void refer(const std::string& name, const std::string& type, const std::string& shape, const void* data,
             std::size_t bytes);
  void keep(const std::string& name, const std::string& type, const std::string& shape, std::string bytes);
  std::vector<Array> arrays_;
};

}  // namespace granrad
