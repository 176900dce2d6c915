#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace granrad {

/// Writes one HDF5 file: to `FILE.tmp` first, and under its name only by `commit`, after fsync; the file is
/// whole or not there. Datasets carry checksums (Fletcher32), integers are compressed, texts have fixed lengths
/// (those of variable length carry no checksum, and damage to them crashes the library). Every failure is an
/// IoError. T is double, std::int64_t, std::int32_t or std::uint8_t. The user of the HDF5 library beside its
/// reader.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::filesystem::path file);
  ~Hdf5Writer();  ///< removes the temporary file unless committed
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Dataset [rows], or [rows, columns] when columns > 1; parent groups are made.
  template <class T>
  void write(const std::string& name, const T* values, std::size_t rows, std::size_t columns = 1);
  template <class T>
  void write(const std::string& name, const std::vector<T>& values) {
    write(name, values.data(), values.size());
  }
  void write(const std::string& name, const std::vector<std::string>& texts);
  void group(const std::string& name);
  /// A second name for the same data (hard link).
  void link(const std::string& existing, const std::string& name);

  /// Text of fixed length in UTF-8: bytes in h5py.
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  /// Text of variable length: a str in h5py. For what people read; its bytes lie in a heap without checksum.
  void variable_text_attribute(const std::string& object, const std::string& name, const std::string& text);
  /// Text of fixed length in ASCII, the only kind VTK reads.
  void fixed_text_attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, const std::vector<std::int64_t>& values);
  void attribute(const std::string& object, const std::string& name, double value);

  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads an HDF5 file, whatever it holds. IoError when it cannot be opened or read (truncated, checksum, sizes
/// beyond what the file can hold), InputError when something asked for is not there or has another shape.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(std::filesystem::path file);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has(const std::string& name) const;
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::vector<std::string> children(const std::string& group) const;  ///< in alphabetical order
  bool is_integer(const std::string& dataset) const;

  /// Values of a dataset [rows] or [rows, columns], row by row.
  template <class T>
  std::vector<T> read(const std::string& name, std::size_t columns = 1) const;
  std::vector<std::string> read_texts(const std::string& name) const;

  std::string text_attribute(const std::string& object, const std::string& name) const;
  std::int64_t integer_attribute(const std::string& object, const std::string& name) const;
  double real_attribute(const std::string& object, const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad
