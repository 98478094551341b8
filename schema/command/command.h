// What all milepost commands share: command line arguments, exit codes, errors in one line,
// progress on a terminal, a clean stop on Ctrl-C.
#pragma once

#include <concepts>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "schema/base/digits.h"
#include "schema/base/result.h"

namespace milepost {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;     // one line on standard error says why
inline constexpr int kExitWrongCall = 2;  // likewise

// Runs a parsed command and returns its exit code.
using RunCommand = std::function<int()>;

// A subcommand: `milepost-mapper build`. add() gives `app` its options and its description, the
// first line of which is its summary in the help of the program.
struct Command {
  std::string name;
  std::function<RunCommand(CLI::App& app)> add;
};

// Parses the command line and runs the subcommand that it names. Handles --help, --version and, for
// every subcommand, --config FILE with one `option = value` per line, where an unknown key is an
// error.
int run_program(const std::string& program, const std::string& description,
                const std::vector<Command>& commands, int argc, const char* const* argv);

// Parses the command line of a program. Returns the exit code if the program ends here: after
// --help or --version, or after an error, which is printed.
std::optional<int> parse_command_line(CLI::App& app, int argc, const char* const* argv);

// "milepost-mapper build", for messages.
std::string name_of(const CLI::App& app);

// The shortest decimal text that parses to the same number, without an exponent: 1000000, 0.04.
template <class Number>
std::string in_digits(Number number) {
  if constexpr (std::integral<Number>) {
    return std::to_string(number);
  } else {
    return shortest_fixed(number);
  }
}

// Adds an option for one number from `low` to `high`. Its help shows the range and `value`, the
// default: "--jobs N    Threads that extract features (1 to 256, default 2)". `unit` is the
// placeholder of the number: N, M, PX.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value,
                        const std::string& unit, const std::string& text,
                        std::type_identity_t<Number> low, std::type_identity_t<Number> high) {
  return app
      .add_option(name, value,
                  text + " (" + in_digits(low) + " to " + in_digits(high) + ", default " +
                      in_digits(value) + ")")
      ->check(CLI::Range(low, high))
      ->option_text(unit);
}

// Prints "PROGRAM: LINE" on standard error and returns kExitFailed.
int fail(const std::string& program, const Error& error);

// Prints "PROGRAM: warning: LINE" on standard error.
void warn(const std::string& program, const Error& error);

// The stream for a command's report on what it wrote: standard output, or standard error if
// `output`, the file that it wrote, is standard output itself.
std::ostream& report_stream(const std::string& output);

// Installs handlers: SIGINT and SIGTERM set a flag; a second signal ends the program.
void catch_stop_signals();
bool stop_requested();

// Whether someone watches: standard error is a terminal. There a command may tell at once what
// otherwise waits for its end, since a failure is one line.
bool shows_progress();

// A progress line, rewritten in place on a terminal; no output elsewhere.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // clears the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const std::string& text);

 private:
  bool on_terminal_;
};

}  // namespace milepost
