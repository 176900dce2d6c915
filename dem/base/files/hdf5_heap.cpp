#include "dem/base/files/hdf5_heap.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <vector>

namespace granrad {

namespace {

constexpr std::string_view mark = "GCOL";
constexpr std::size_t head_bytes = 16;  // of a collection and of an object
constexpr std::uint64_t largest_collection = 1 << 26;

/// A little-endian number.
template <class T>
T number(const std::string& bytes, std::size_t at) {
  T value = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k)
    value |= static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[at + k])) << (8 * k));
  return value;
}

std::optional<std::string> bytes_at(std::ifstream& in, std::uint64_t at, std::uint64_t count) {
  if (!in || count > largest_collection || at > (std::uint64_t{1} << 62)) return {};
  std::string bytes(count, '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  if (static_cast<std::uint64_t>(in.gcount()) != count) return {};
  return bytes;
}

/// The collection at an address, whole; nothing when there is none.
std::optional<std::string> collection_at(std::ifstream& in, std::uint64_t address) {
  const auto head = bytes_at(in, address, head_bytes);
  if (!head || !head->starts_with(mark) || (*head)[4] != 1) return {};
  const auto size = number<std::uint64_t>(*head, 8);
  if (size < head_bytes) return {};
  return bytes_at(in, address, size);
}

/// Calls visit(object number, begin, size) for each object until it returns false; false when they do not add up.
bool walk(const std::string& collection,
          const std::function<bool(std::uint16_t, std::size_t, std::uint64_t)>& visit) {
  std::size_t at = head_bytes;
  while (at + head_bytes <= collection.size()) {
    const auto object = number<std::uint16_t>(collection, at);
    const auto size = number<std::uint64_t>(collection, at + 8);
    if (object == 0)
      return size == collection.size() - at;  // free space, to the end; less and HDF5 never ends
    if (number<std::uint32_t>(collection, at + 4) != 0) return false;  // reserved
    if (size > collection.size() - at - head_bytes) return false;
    if (!visit(object, at + head_bytes, size)) return true;
    at += head_bytes + (size + 7) / 8 * 8;
  }
  return at <= collection.size();
}

}  // namespace

std::optional<Hdf5Heap::Reference> Hdf5Heap::reference(std::uint64_t offset, std::size_t k) const {
  std::ifstream in(file_, std::ios::binary);
  const auto bytes = bytes_at(in, offset + k * reference_bytes, reference_bytes);
  if (!bytes) return {};
  return Reference{number<std::uint32_t>(*bytes, 0), number<std::uint64_t>(*bytes, 4),
                   number<std::uint32_t>(*bytes, 12)};
}

std::optional<std::string> Hdf5Heap::text(const Reference& reference) const {
  if (reference.length == 0) return std::string();
  std::ifstream in(file_, std::ios::binary);
  const auto collection = collection_at(in, reference.address);
  if (!collection) return {};
  std::optional<std::string> found;
  walk(*collection, [&](std::uint16_t object, std::size_t begin, std::uint64_t size) {
    if (object != reference.object) return true;
    if (size >= reference.length) found = collection->substr(begin, reference.length);
    return false;
  });
  if (found) found->resize(std::min(found->find('\0'), found->size()));
  return found;
}

bool Hdf5Heap::is_sound() const {
  std::ifstream in(file_, std::ios::binary), at_collection(file_, std::ios::binary);
  constexpr std::size_t block = 1 << 20;
  std::string window;
  for (std::uint64_t begin = 0;;) {
    const std::size_t kept = window.size();
    window.resize(kept + block);
    in.read(window.data() + kept, block);
    window.resize(kept + static_cast<std::size_t>(in.gcount()));
    for (auto at = window.find(mark); at != window.npos; at = window.find(mark, at + 1)) {
      const auto collection = collection_at(at_collection, begin + at);
      if (collection && !walk(*collection, [](std::uint16_t, std::size_t, std::uint64_t) { return true; }))
        return false;
    }
    if (!in) return true;
    const std::size_t tail = std::min(window.size(), mark.size() - 1);
    begin += window.size() - tail;
    window.erase(0, window.size() - tail);
  }
}

}  // namespace granrad
