#pragma once
#include <CLI/CLI.hpp>

namespace granrad {

/// Help of `app` and of every subcommand within 80 columns. To be called before subcommands are added: they inherit it.
void set_manners(CLI::App& app);

/// Says what is wrong with the words of a command line (an unknown subcommand or option with the closest known one, a
/// value that is no choice, else the parser's words), then whose --help to see. Returns the exit code: 0 for help and
/// version, 2 otherwise.
int usage_exit(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace granrad
