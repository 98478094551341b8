#include "schema/command/command.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>

#include "schema/command/version.h"

namespace milepost {

std::string name_of(const CLI::App& app) {
  const CLI::App* program = app.get_parent();
  return program == nullptr ? app.get_name() : program->get_name() + " " + app.get_name();
}

namespace {

volatile std::sig_atomic_t stop_signals = 0;

void note_stop(int signal) {
  stop_signals = stop_signals + 1;
  std::signal(signal, SIG_DFL);
}

constexpr const char* kConfig = "--config";
constexpr const char* kConfigText =
    "Read options from FILE: one 'option = value' per line, '#' comments";

// Lists each subcommand by the first line of its description.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(34);
    label("SUBCOMMAND", "COMMAND");
  }

 private:
  std::string make_description(const CLI::App* app) const override {
    const std::string description = CLI::Formatter::make_description(app);
    return app->get_name().empty() ? description
                                   : description + "\n";  // option groups have no name
  }

  std::string make_subcommand(const CLI::App* sub) const override {
    constexpr std::size_t kNameWidth = 14;
    const std::string description = sub->get_description();
    std::ostringstream line;
    CLI::detail::format_help(line, sub->get_name(), description.substr(0, description.find('\n')),
                             kNameWidth);
    return line.str();
  }
};

// Applies a file of `option = value` lines to the subcommand that was called.
class SubcommandConfig : public CLI::ConfigTOML {
 public:
  explicit SubcommandConfig(const CLI::App& program) : program_(program) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> settings = CLI::ConfigTOML::from_config(input);
    for (const CLI::App* called : program_.get_subcommands()) {
      for (CLI::ConfigItem& setting : settings)
        setting.parents.insert(setting.parents.begin(), called->get_name());
    }
    return settings;
  }

 private:
  const CLI::App& program_;
};

void set_up(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.set_version_flag("--version", name_of(app) + " " + kVersion);
}

std::string in_one_line(const Error& error) {
  std::string line = error.line();
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::string what_is_wrong(const CLI::App& called, const CLI::ParseError& error) {
  if (called.get_require_subcommand_min() > 0) {
    const std::vector<std::string> arguments = called.remaining();
    return arguments.empty() ? "a command is missing"
                             : "'" + arguments.front() + "' is not a command";
  }
  std::string what = error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  constexpr std::string_view kUnknownKey =
      "INI was not able to parse ";  // CLI11; COMMAND.KEY follows
  if (!what.starts_with(kUnknownKey)) return what;
  return "--config: the file has the unknown key '" + what.substr(what.find_last_of(" .") + 1) +
         "'";
}

int wrong_call(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> subcommands = app.get_subcommands();
  const CLI::App& called = subcommands.empty() ? app : *subcommands.front();
  std::cerr << name_of(called) << ": " << what_is_wrong(called, error) << "; see '"
            << name_of(called) << " --help'\n";
  return kExitWrongCall;
}

std::optional<int> parsed(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return wrong_call(app, error);
  }
}

}  // namespace

std::optional<int> parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  set_up(app);
  app.set_config(kConfig, "", kConfigText)->check(CLI::ExistingFile)->option_text("FILE");
  return parsed(app, argc, argv);
}

int run_program(const std::string& program, const std::string& description,
                const std::vector<Command>& commands, int argc, const char* const* argv) {
  CLI::App app(description, program);
  set_up(app);
  app.require_subcommand(1);
  app.footer("'" + program + " COMMAND --help' describes a command and its options.");
  CLI::Option* config = app.set_config(kConfig)->group("");
  app.config_formatter(std::make_shared<SubcommandConfig>(app));
  std::map<const CLI::App*, RunCommand> runs;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name)->group("Commands");
    set_up(*sub);
    sub->footer("");
    // CLI11 reads the configuration file of a program, not of a subcommand: it is passed on.
    const auto pass_on = [config](const std::string& file) { config->add_result(file); };
    sub->add_option_function<std::string>(kConfig, pass_on, kConfigText)
        ->trigger_on_parse()
        ->check(CLI::ExistingFile)
        ->option_text("FILE")
        ->configurable(false);
    runs[sub] = command.add(*sub);
  }
  if (const auto code = parsed(app, argc, argv)) return *code;
  return runs.at(app.get_subcommands().front())();
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

bool shows_progress() { return ::isatty(STDERR_FILENO) == 1; }

ProgressLine::ProgressLine() : on_terminal_(shows_progress()) {}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressLine::show(const std::string& text) {
  if (on_terminal_) std::cerr << "\r\x1b[K" << text << std::flush;
}

}  // namespace milepost
