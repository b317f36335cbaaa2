// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/program/exit_code.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace palpate::program {

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
  /// Numbers in [low, high]. @param[in] unit  for --help and for who is refused, e.g. "m"
  Option& range(int low, int high, const std::string& unit = {});
  Option& range(std::int64_t low, std::int64_t high, const std::string& unit = {});
  Option& range(double low, double high, const std::string& unit = {});
  /// Numbers of any size. @param[in] unit  as above
  Option& unit(const std::string& unit);
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
  /// A group of options, of which one may be there.
  [[nodiscard]] Options atMostOneOf(const std::string& name);
  /// Exactly one subcommand must be there.
  [[nodiscard]] Options subcommand(const std::string& name, const std::string& help);
  /// A command line that does something useful, for --help. Once for the program and once for each subcommand.
  void example(const std::string& command);
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
  /// Text below the options, above the line about exit codes.
  void footer(const std::string& text);

  /// Fills the targets. An option that does not exist is refused before anything else, with the name that is nearest to it.
  /// The value behind an option may be a negative number, also as the first of several: -1,0,0. So may a side: -x.
  /// @return false after --help or --version, answered on standard output
  /// @throw UsageError
  [[nodiscard]] bool read(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace palpate::program
