#include "schema/command/command.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>

#include "schema/command/version.h"

namespace milepost {
namespace {

volatile std::sig_atomic_t stop_signals = 0;

void note_stop(int signal) {
  stop_signals = stop_signals + 1;
  std::signal(signal, SIG_DFL);
}

std::string program_help(const std::string& program, const std::string& description,
                         const std::vector<Command>& commands) {
  std::string text = description + "\n\nUsage: " + program + " COMMAND [OPTIONS]\n\nCommands:\n";
  std::size_t width = 0;
  for (const Command& command : commands) width = std::max(width, command.name.size());
  for (const Command& command : commands) {
    text += "  " + command.name + std::string(width + 2 - command.name.size(), ' ') +
            command.summary + "\n";
  }
  return text + "\n'" + program + " COMMAND --help' tells all about one of them; '" + program +
         " --version' the version.\n";
}

std::string in_one_line(const Error& error) {
  std::string line = error.line();
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

int wrong_call(const std::string& program, const std::string& what) {
  std::cerr << program << ": " << what << "; see '" << program << " --help'\n";
  return kExitWrongCall;
}

}  // namespace

int run_program(const std::string& program, const std::string& description,
                const std::vector<Command>& commands, int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return wrong_call(program, "a command is missing");
  if (words[0] == "--help" || words[0] == "-h") {
    std::cout << program_help(program, description, commands);
    return kExitDone;
  }
  if (words[0] == "--version") {
    std::cout << program << " " << kVersion << "\n";
    return kExitDone;
  }
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const Command& c) { return c.name == words[0]; });
  if (command == commands.end()) return wrong_call(program, "'" + words[0] + "' is no command");
  return command->run(program + " " + command->name, {words.begin() + 1, words.end()});
}

std::optional<int> parse_words(CLI::App& app, std::vector<std::string> words) {
  app.set_config("--config", "",
                 "Read options from FILE: one 'option = value' a line, '#' comments")
      ->check(CLI::ExistingFile)
      ->option_text("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.set_version_flag("--version", app.get_name() + " " + kVersion);
  app.get_formatter()->column_width(34);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(std::move(words));
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return kExitDone;
  } catch (const CLI::CallForVersion&) {
    std::cout << app.version() << "\n";
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    return wrong_call(app.get_name(), what);
  }
}

int fail(const std::string& program, const Error& error) {
  std::cerr << program << ": " << in_one_line(error) << "\n";
  return kExitFailed;
}

void warn(const std::string& program, const Error& error) {
  std::cerr << program << ": warning: " << in_one_line(error) << "\n";
}

std::ostream& report_stream(const std::string& output) {
  const std::string path = std::filesystem::path(output).lexically_normal().string();
  const bool is_stdout = path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
  return is_stdout ? std::cerr : std::cout;
}

void catch_stop_signals() {
  std::signal(SIGINT, note_stop);
  std::signal(SIGTERM, note_stop);
}

bool stop_requested() { return stop_signals > 0; }

ProgressLine::ProgressLine() : on_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressLine::show(const std::string& text) {
  if (on_terminal_) std::cerr << "\r\x1b[K" << text << std::flush;
}

}  // namespace milepost
