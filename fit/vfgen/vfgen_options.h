#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "dem/base/program.h"

namespace granrad {

/// What the subcommand chosen does, once the options are known: its exit code.
using Body = std::function<int(Verbosity)>;

/// A number in [low, high]; unlike CLI::Range it refuses NaN and what follows a number.
CLI::Validator number_in(double low, double high);

/// A whole number >= 0 that std::int64_t holds; CLI11 would let -1 wrap around.
CLI::Validator seed_number();

/// A size such as 4GiB or 512MB, made bytes; at least 1 byte, at most 2^50. CLI11 lets -1 and 1e20 wrap around.
CLI::Validator memory_size();

/// Subcommands with many options.
void add_trace(CLI::App& app, Body& body);
void add_fit(CLI::App& app, Body& body);

}  // namespace granrad
