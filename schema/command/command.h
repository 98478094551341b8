// What every milepost command does alike: words on the command line, exit codes, errors in one
// line, progress on a terminal, a clean stop on Ctrl-C.
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
inline constexpr int kExitWrongCall = 2;  // so does it here

// A subcommand: `milepost-mapper build`. run() gets the words that follow its name.
struct Command {
  std::string name;
  std::string summary;
  std::function<int(const std::string& program, std::vector<std::string> words)> run;
};

// Chooses the subcommand by the first word and runs it; answers --help and --version itself.
int run_program(const std::string& program, const std::string& description,
                const std::vector<Command>& commands, int argc, char** argv);

// A number as people write it, as short as its type allows: 1000000, 0.04.
template <class Number>
std::string in_digits(Number number) {
  if constexpr (std::integral<Number>) {
    return std::to_string(number);
  } else {
    return shortest_fixed(number);
  }
}

// Adds an option for one number from `low` to `high`. Its help says so, with the default that
// `value` holds: "--jobs N    Threads that extract features (1 to 256, default 2)".
// `unit` stands for the number: N, M, PX.
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

// Parses `words` by `app`; the option --config (a file with one option a line, as key = value) is
// added, in which an unknown key is an error. Returns the exit code if the command is to end here.
std::optional<int> parse_words(CLI::App& app, std::vector<std::string> words);

// Prints "PROGRAM: LINE" on standard error and returns kExitFailed.
int fail(const std::string& program, const Error& error);

// Prints "PROGRAM: warning: LINE" on standard error.
void warn(const std::string& program, const Error& error);

// Where a command says what it wrote: on standard output, or on standard error where `output`, the
// file that it wrote, is standard output itself.
std::ostream& report_stream(const std::string& output);

// From now on SIGINT and SIGTERM set a flag instead of ending the program; a second one ends it.
void catch_stop_signals();
bool stop_requested();

// A line that is rewritten in place on a terminal, and nothing at all elsewhere.
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
