#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace granrad {

/// The identifier of an enumerator, from what the compiler calls it ("granrad::WallRole::open" -> "open").
/// Does not compile for a number that no enumerator has.
template <auto value>
constexpr std::string_view enumerator() {
  const std::string_view text = __PRETTY_FUNCTION__;  // GCC and Clang: "... value = granrad::WallRole::open]"
  const auto begin = text.find("value = ") + 8;
  const auto whole = text.substr(begin, text.find_first_of(";]", begin) - begin);
  if (whole.find('(') != whole.npos) throw std::logic_error("a number without an enumerator");
  return whole.substr(whole.rfind(':') + 1);
}

/// What the values of an enumeration are called in scenes, files and messages: as their enumerators, the one list by
/// which they are written and read. `last` is the last value; the values are 0, 1, ... `last` (else it does not compile).
template <auto last>
class ChoiceNames {
 public:
  using Enum = decltype(last);
  static constexpr std::size_t count = static_cast<std::size_t>(last) + 1;

  constexpr const char* of(Enum value) const { return names_.at(static_cast<std::size_t>(value)); }
  constexpr std::optional<Enum> value(std::string_view name) const {
    for (std::size_t k = 0; k < count; ++k)
      if (name == names_[k]) return static_cast<Enum>(k);
    return {};
  }
  std::vector<std::string> all() const { return {names_.begin(), names_.end()}; }

 private:
  template <auto choice>
  static constexpr auto terminated = [] {
    std::array<char, enumerator<choice>().size() + 1> text{};
    for (std::size_t k = 0; k + 1 < text.size(); ++k) text[k] = enumerator<choice>()[k];
    return text;
  }();
  template <std::size_t... k>
  static constexpr std::array<const char*, count> names_of(std::index_sequence<k...>) {
    return {terminated<static_cast<Enum>(k)>.data()...};
  }
  static constexpr std::array<const char*, count> names_ = names_of(std::make_index_sequence<count>());
};

}  // namespace granrad
