// SPDX-License-Identifier: Apache-2.0
#include "tools/program/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iostream>
#include <span>
#include <sstream>
#include <type_traits>

#include "tools/program/nearest_word.h"

namespace palpate::program {
namespace {

constexpr const char* kMore = " (--help tells more)";

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

std::vector<CLI::App*> subcommandsOf(CLI::App& app) {
  return app.get_subcommands([](CLI::App* sub) { return !sub->get_name().empty(); });
}

bool takesAValue(CLI::App& app, const std::string& word) {
  if (const CLI::Option* option = app.get_option_no_throw(word)) return option->get_items_expected_max() > 0;
  const auto subcommands = subcommandsOf(app);
  return std::any_of(subcommands.begin(), subcommands.end(),
                     [&](CLI::App* sub) { return takesAValue(*sub, word); });
}

bool beginsNegative(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         (std::isdigit(static_cast<unsigned char>(word[1])) || word[1] == '.');
}

// "-x", a side of a body.
bool isSide(const std::string& word) {
  return word.size() == 2 && word[0] == '-' && word[1] >= 'x' && word[1] <= 'z';
}

// The words behind the program's name. "--option -.1,0,0" becomes "--option=-.1,0,0", else CLI11 would look for an
// option "-."; likewise "--option -x".
std::vector<std::string> wordsOf(CLI::App& app, std::span<const char* const> given) {
  std::vector<std::string> words;
  for (const std::string word : given) {
    if (!words.empty() && (beginsNegative(word) || isSide(word)) && words.back().starts_with("--") &&
        takesAValue(app, words.back()))
      words.back() += "=" + word;
    else
      words.push_back(word);
  }
  return words;
}

std::vector<std::string> namesOf(const std::vector<CLI::App*>& subcommands) {
  std::vector<std::string> names;
  for (const CLI::App* sub : subcommands) names.push_back(sub->get_name());
  return names;
}

// "--depth" of an app's options and of those of its groups.
void collectLongNames(CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; }))
    if (sub->get_name().empty()) collectLongNames(*sub, names);
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  const auto nearest = nearestWord(word, known);
  return nearest ? ": did you mean " + *nearest + "?" : kMore;
}

// Refused here, because CLI11 looks for what is missing first. From a subcommand's name on, its options are known too.
void refuseUnknown(CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  collectLongNames(app, known);
  const std::vector<CLI::App*> subcommands = subcommandsOf(app);
  bool chosen = subcommands.empty();
  bool is_value = false;
  for (const std::string& word : words) {
    if (word == "--") return;
    const auto sub = std::find_if(subcommands.begin(), subcommands.end(),
                                  [&](const CLI::App* each) { return each->get_name() == word; });
    if (sub != subcommands.end()) collectLongNames(**sub, known);
    const std::string name = word.substr(0, word.find('='));
    if (word.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end())
      throw UsageError("unknown option " + name + didYouMean(name, known));
    if (!chosen && !is_value && sub == subcommands.end() && !word.starts_with("-"))
      throw UsageError("unknown subcommand " + word + didYouMean(word, namesOf(subcommands)));
    chosen = chosen || sub != subcommands.end();
    is_value = word.starts_with("-") && takesAValue(app, word);
  }
}

template <class Number>
std::string describeRange(Number low, Number high, const std::string& unit, const char* between) {
  std::ostringstream text;
  text << low << between << high << (unit.empty() ? "" : " ") << unit;
  return text.str();
}

// CLI::Range says "Value 10 not in range 1 to 9", and knows no unit.
template <class Number>
CLI::Validator inRange(Number low, Number high, const std::string& unit) {
  const auto refusal = [=](std::string& word) -> std::string {
    Number value{};
    if (CLI::detail::lexical_cast(word, value) && value >= low && value <= high) return {};
    double number = 0.0;
    std::string why = " is out of range";
    if (!CLI::detail::lexical_cast(word, number))
      why = " is not a number";
    else if (std::is_integral_v<Number> && number != std::floor(number))
      why = " is not a whole number";
    return word + why + ", expected " + describeRange(low, high, unit, " to ");
  };
  return CLI::Validator(refusal, "[" + describeRange(low, high, unit, " - ") + "]");
}

CLI::Validator isNumber(const std::string& unit) {
  const auto refusal = [=](std::string& word) -> std::string {
    double value = 0.0;
    return CLI::detail::lexical_cast(word, value) ? "" : word + " is not a number, expected one in " + unit;
  };
  return CLI::Validator(refusal, "[" + unit + "]");
}

// "Could not convert: --node = one" says neither what is wrong nor what is right.
std::string complaintOf(const CLI::ParseError& error) {
  const std::string text = error.what();
  const std::string begin = "Could not convert: ";
  const std::size_t equals = text.find(" = ");
  if (!text.starts_with(begin) || equals == std::string::npos) return text;
  const std::string value = text.substr(equals + 3);
  double number = 0.0;
  const bool fits = CLI::detail::lexical_cast(value, number);
  return text.substr(begin.size(), equals - begin.size()) + ": " + value +
         (fits ? " is not a whole number in range" : " is not a number");
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::range(int low, int high, const std::string& unit) {
  option_->check(inRange(low, high, unit));
  return *this;
}

Option& Option::range(std::int64_t low, std::int64_t high, const std::string& unit) {
  option_->check(inRange(low, high, unit));
  return *this;
}

Option& Option::range(double low, double high, const std::string& unit) {
  option_->check(inRange(low, high, unit));
  return *this;
}

Option& Option::unit(const std::string& unit) {
  option_->check(isNumber(unit));
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

Options Options::atMostOneOf(const std::string& name) {
  CLI::Option_group* const group = app_->add_option_group(name);
  group->require_option(0, 1);
  return Options(*group);
}

Options Options::subcommand(const std::string& name, const std::string& help) {
  app_->require_subcommand(1);
  CLI::App* const sub = app_->add_subcommand(name, help);
  sub->footer(kExitCodes);
  return Options(*sub);
}

void Options::example(const std::string& command) {
  app_->footer("Example: " + command + "\n" + kExitCodes);
}

bool Options::chosen() const {
  return app_->parsed();
}

CommandLine::CommandLine(const std::string& name, const std::string& about, const std::string& version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->set_version_flag("--version", version);
  app_->footer(kExitCodes);
}

CommandLine::~CommandLine() = default;

Options CommandLine::options() {
  return Options(*app_);
}

void CommandLine::footer(const std::string& text) {
  app_->footer(text + "\n" + kExitCodes);
}

bool CommandLine::read(int argc, const char* const* argv) {
  std::vector<std::string> words =
      wordsOf(*app_, std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0));
  refuseUnknown(*app_, words);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app_->parse(std::move(words));
    return true;
  } catch (const CLI::Success& answered) {
    app_->exit(answered, std::cout, std::cerr);
    return false;
  } catch (const CLI::ParseError& error) {
    throw UsageError(complaintOf(error) + kMore);
  }
}

}  // namespace palpate::program
