// SPDX-License-Identifier: Apache-2.0
#include "tools/program/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>
#include <span>

namespace palpate::program {
namespace {

template <class T>
bool shows(const T& value) {
  if constexpr (std::is_arithmetic_v<T>)
    return true;
  else
    return !value.empty();
}

template <class T>
bool shows(const std::optional<T>&) {
  return false;
}

bool takesAValue(CLI::App& app, const std::string& word) {
  if (const CLI::Option* option = app.get_option_no_throw(word)) return option->get_items_expected_max() > 0;
  const auto subcommands = app.get_subcommands([](CLI::App* sub) { return !sub->get_name().empty(); });
  return std::any_of(subcommands.begin(), subcommands.end(),
                     [&](CLI::App* sub) { return takesAValue(*sub, word); });
}

bool beginsNegative(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         (std::isdigit(static_cast<unsigned char>(word[1])) || word[1] == '.');
}

// The words behind the program's name. "--option -.1,0,0" becomes "--option=-.1,0,0", else CLI11 would look for an option
// "-.".
std::vector<std::string> wordsOf(CLI::App& app, std::span<const char* const> given) {
  std::vector<std::string> words;
  for (const std::string word : given) {
    if (!words.empty() && beginsNegative(word) && words.back().starts_with("--") &&
        takesAValue(app, words.back()))
      words.back() += "=" + word;
    else
      words.push_back(word);
  }
  return words;
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::range(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::range(double low, double high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::rangeOr(double low, double high, const std::vector<std::string>& words) {
  option_->check(CLI::Validator(CLI::Range(low, high)) | CLI::IsMember(words));
  return *this;
}

Option& Option::oneOf(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option& Option::list(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::oneWordEach() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::valueName(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Options::add(const std::string& names, Target target, const std::string& help) {
  return std::visit(
      [&](auto* variable) {
        CLI::Option* const option = app_->add_option(names, *variable, help);
        if (shows(*variable)) option->capture_default_str();
        return Option(*option);
      },
      target);
}

void Options::flag(const std::string& names, bool* target, const std::string& help) {
  app_->add_flag(names, *target, help);
}

// CLI11 2.1.2 writes false into an optional<bool> whose flag is absent.
void Options::flag(const std::string& names, std::optional<bool>* target, const std::string& help) {
  app_->add_flag_function(
      names, [target](std::int64_t count) { *target = count > 0; }, help);
}

Options Options::exactlyOneOf(const std::string& name) {
  CLI::Option_group* const group = app_->add_option_group(name);
  group->require_option(1);
  return Options(*group);
}

Options Options::subcommand(const std::string& name, const std::string& help) {
  app_->require_subcommand(1);
  return Options(*app_->add_subcommand(name, help));
}

bool Options::chosen() const {
  return app_->parsed();
}

CommandLine::CommandLine(const std::string& name, const std::string& about, const std::string& version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->set_version_flag("--version", version);
}

CommandLine::~CommandLine() = default;

Options CommandLine::options() {
  return Options(*app_);
}

void CommandLine::footer(const std::string& text) {
  app_->footer(text);
}

bool CommandLine::read(int argc, const char* const* argv) {
  std::vector<std::string> words =
      wordsOf(*app_, std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0));
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app_->parse(std::move(words));
    return true;
  } catch (const CLI::Success& answered) {
    app_->exit(answered, std::cout, std::cerr);
    return false;
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what(), error.get_exit_code());
  }
}

}  // namespace palpate::program
