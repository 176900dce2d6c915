#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace granrad {

/// The global heap of an HDF5 file, where texts of variable length are kept. It has no checksums and the library
/// trusts it: a damaged one crashes it or spins. We write no such texts; those of older files are looked up here,
/// with every length checked (HDF5 File Format Specification 3.0, III.E Global Heap).
class Hdf5Heap {
 public:
  /// What a variable-length text is in its dataset: 16 bytes.
  struct Reference {
    std::uint32_t length = 0;
    std::uint64_t address = 0;
    std::uint32_t object = 0;
  };

  explicit Hdf5Heap(std::filesystem::path file) : file_(std::move(file)) {}
  static constexpr std::size_t reference_bytes = 16;
  /// Reference number k of the dataset whose data begin at `offset`; nothing where the file ends.
  std::optional<Reference> reference(std::uint64_t offset, std::size_t k) const;
  /// The text; nothing when it is not there.
  std::optional<std::string> text(const Reference& reference) const;
  /// Whether the objects of every collection of the file add up.
  bool is_sound() const;

 private:
  std::filesystem::path file_;
};

}  // namespace granrad
