#pragma once
#include <boost/hana/accessors.hpp>
#include <boost/hana/adapt_struct.hpp>
#include <boost/hana/first.hpp>
#include <boost/hana/for_each.hpp>
#include <boost/hana/second.hpp>
#include <boost/hana/string.hpp>
#include <boost/hana/tuple.hpp>
#include <type_traits>

#include "dem/io/snapshot.h"

namespace granrad {

/// Reading back what a frame holds beside the Bed. Each throws InputError when it is not there: the frame is
/// none of a run, or of another version of the program.
const StateBlock& saved_block(const Snapshot& frame, const std::string& name);
double saved_real(const StateBlock& block, const std::string& name);
std::int64_t saved_integer(const StateBlock& block, const std::string& name);
const std::vector<double>& saved_reals(const StateBlock& block, const std::string& name);

/// Both ways of one list: the members of `values` that a restart needs, each under its own name, whole numbers among
/// the integers. They are named once, by BOOST_HANA_ADAPT_STRUCT where this is called.
template <class Values>
void save_values(const Values& values, StateBlock& block) {
  boost::hana::for_each(boost::hana::accessors<Values>(), [&](auto member) {
    const char* const name = boost::hana::first(member).c_str();
    const auto value = boost::hana::second(member)(values);
    if constexpr (std::is_integral_v<decltype(value)>)
      block.integers[name] = {value};
    else
      block.reals[name] = {value};
  });
}
template <class Values>
void restore_values(Values& values, const StateBlock& block) {
  boost::hana::for_each(boost::hana::accessors<Values>(), [&](auto member) {
    const char* const name = boost::hana::first(member).c_str();
    auto& value = boost::hana::second(member)(values);
    if constexpr (std::is_integral_v<std::remove_reference_t<decltype(value)>>)
      value = saved_integer(block, name);
    else
      value = saved_real(block, name);
  });
}

}  // namespace granrad
