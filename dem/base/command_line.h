#pragma once
#include <CLI/CLI.hpp>

namespace granrad {

/// Help of `app` and of every subcommand within 80 columns. To be called before subcommands are added: they inherit it.
void set_manners(CLI::App& app);

/// What the parser says about `error`, and the closest known word for a subcommand or option that is none. Returns the
/// exit code: 0 for help and version, 2 otherwise.
int usage_exit(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace granrad
