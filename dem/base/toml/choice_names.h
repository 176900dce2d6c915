#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// What the values of an enumeration are called in scenes, files and messages: one list, by which they are written and
/// read. `last` is the last value; the list names every value from 0 to it, in order (else it does not compile).
template <auto last>
class ChoiceNames {
 public:
  using Enum = decltype(last);
  struct Named {
    Enum value;
    const char* name;
  };
  static constexpr std::size_t count = static_cast<std::size_t>(last) + 1;

  constexpr explicit ChoiceNames(const std::array<Named, count>& all) {
    for (std::size_t k = 0; k < count; ++k) {
      if (static_cast<std::size_t>(all[k].value) != k || !all[k].name)
        throw std::logic_error("names out of order");
      name_[k] = all[k].name;
    }
  }
  constexpr const char* of(Enum value) const { return name_.at(static_cast<std::size_t>(value)); }
  constexpr std::optional<Enum> value(std::string_view name) const {
    for (std::size_t k = 0; k < count; ++k)
      if (name == name_[k]) return static_cast<Enum>(k);
    return {};
  }
  std::vector<std::string> all() const { return {name_.begin(), name_.end()}; }

 private:
  std::array<const char*, count> name_{};
};

}  // namespace granrad
