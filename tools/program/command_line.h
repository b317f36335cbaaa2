// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace palpate::program {

/// A command line that cannot be used. what() is one line that names the option.
class UsageError : public std::runtime_error {
 public:
  UsageError(const std::string& complaint, int exit_code)
      : std::runtime_error(complaint), exit_code_(exit_code) {}
  [[nodiscard]] int exitCode() const noexcept { return exit_code_; }

 private:
  int exit_code_;
};

/// The variable that an option fills. Its type is the option's; what it holds is the default, which --help shows unless
/// it is empty.
using Target = std::variant<std::string*, std::filesystem::path*, double*, int*, std::uint16_t*,
                            std::uint32_t*, std::size_t*, std::optional<std::string>*, std::optional<double>*,
                            std::optional<int>*, std::optional<std::int64_t>*, std::vector<std::string>*,
                            std::vector<int>*, std::vector<std::uint32_t>*, std::array<int, 3>*>;

/// One option, to say more of it. Each call returns the option.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  /// Numbers in [low, high].
  Option& range(int low, int high);
  Option& range(double low, double high);
  /// Numbers in [low, high], or one of the words.
  Option& rangeOr(double low, double high, const std::vector<std::string>& words);
  Option& oneOf(const std::vector<std::string>& words);
  /// A list in one word, its entries parted by `separator`.
  Option& list(char separator);
  /// A list that takes one word each time the option is given.
  Option& oneWordEach();
  /// What --help calls its value.
  Option& valueName(const std::string& name);

 private:
  CLI::Option* option_;
};

/// Options of a program, of one of its subcommands, or of a group.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(&app) {}

  /// @param[in] names  "--long", "-s,--long", or "name" for a word without dashes
  Option add(const std::string& names, Target target, const std::string& help);
  void flag(const std::string& names, bool* target, const std::string& help);
  /// Left empty when the flag is absent. @param[in] names  "--flag,!--no-flag": the second says false
  void flag(const std::string& names, std::optional<bool>* target, const std::string& help);
  /// A group of options, of which exactly one must be there.
  [[nodiscard]] Options exactlyOneOf(const std::string& name);
  /// Exactly one subcommand must be there.
  [[nodiscard]] Options subcommand(const std::string& name, const std::string& help);
  /// Whether the subcommand was read.
  [[nodiscard]] bool chosen() const;

 private:
  CLI::App* app_;
};

/// The command line of a program, with --help and --version. Real-time: no.
class CommandLine {
 public:
  /// @param[in] about  what the program does, for --help  @param[in] version  what --version prints
  CommandLine(const std::string& name, const std::string& about,
              const std::string& version = PALPATE_VERSION);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Options options();
  /// Text below the options.
  void footer(const std::string& text);

  /// Fills the targets. The value behind an option may be a negative number, also as the first of several: -1,0,0.
  /// @return false after --help or --version, answered on standard output
  /// @throw UsageError
  [[nodiscard]] bool read(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace palpate::program
