#pragma once
#include <cstdio>
#include <functional>
#include <string>

namespace granrad {

/// How much a command says: results and errors; also progress and notes; also what each part does.
enum class Verbosity { quiet, normal, verbose };

/// Version and git commit this binary was built from.
const char* program_version();
const char* program_git_sha();

/// A message or a note: on a terminal within its width, broken at spaces; elsewhere as it is, one a line.
void print_message(const std::string& text, std::FILE* where = stderr);

/// Runs a program's body and turns its errors into messages on stderr and the exit codes of error.h;
/// an interrupt caught by `install_signal_handlers` ends as 128 + its number: 129 (SIGHUP), 130 (SIGINT), 143
/// (SIGTERM).
int run_program(const std::string& name, const std::function<int()>& body);

/// Keeps freed memory for the next allocation, as run_program does. Lists of pairs are made and freed at every heat step; the
/// kernel would take and clear their pages each time: 40 % of all page faults and 6 % of a run with a heat step every 10 DEM
/// steps.
void keep_freed_memory();

/// After this, SIGINT, SIGTERM and SIGHUP (unless it is ignored, as under nohup) only set a flag; the time loop
/// looks at it, saves and returns. A second signal ends the process at once. SIGUSR1 asks for a checkpoint.
void install_signal_handlers();
/// 0, or the signal number received.
int interrupt_signal();
/// Throws an Error when a signal asked to stop: for loops that may take long, so that it is obeyed within seconds.
void stop_if_interrupted();
/// Whether a SIGUSR1 came since it was last asked.
bool take_checkpoint_request();

/// "12.3 s of computing on all threads, 4.5 s by the clock, 120 MB at most": of this process so far.
std::string resources_used();
/// UTC, as 2026-01-31T23:59:59Z.
std::string date_of_now();
double wall_seconds();  ///< by the clock, since this process started

/// What is left of `total` at the pace since the first look, when `done_first` was there already: set-up before it, and
/// what an earlier run had done, do not count. Infinite before anything is done.
double remaining_seconds(double done_first, double since_first_s, double done, double total);

/// Progress with ETA on stderr: a line that rewrites itself on a terminal, else a line every 30 s or so.
/// Quiet prints nothing. Costs a clock read per call.
class Progress {
 public:
  Progress(std::string what, double total, bool quiet);
  ~Progress();
  void update(double done, const std::string& detail = "");
  void finish(const std::string& detail = "");

 private:
  void print(double done, const std::string& detail, bool last);
  std::string what_;
  double total_, started_s_, printed_s_ = -1e9;
  double first_done_ = 0, first_s_ = -1;  ///< at the first update
  bool quiet_, terminal_, finished_ = false;
};

}  // namespace granrad
