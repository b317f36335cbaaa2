// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/fill.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <sstream>

namespace palpate::reproduce {

namespace {

using Arguments = fmt::dynamic_format_arg_store<fmt::format_context>;

void addLeaves(const std::string& name, const Json& json, Arguments& arguments) {
  if (json.isNumber()) {
    const auto x = json.get<double>();
    arguments.push_back(fmt::arg(name.c_str(), x));
    arguments.push_back(fmt::arg(("pct_" + name).c_str(), 100.0 * x));
  } else if (json.isString()) {
    arguments.push_back(fmt::arg(name.c_str(), json.text()));
  } else if (json.isObject()) {
    for (const auto& [key, value] : json.members())
      addLeaves(name.empty() ? key : name + "_" + key, value, arguments);
  } else if (json.isArray() && json.size() <= 32) {  // longer ones are data, not prose
    for (std::size_t i = 0; i < json.size(); ++i)
      addLeaves(name + "_" + std::to_string(i), json[i], arguments);
  }
}

}  // namespace

std::string fill(std::string_view text, const Json& results) {
  Arguments arguments;
  addLeaves("", results, arguments);
  try {
    return fmt::vformat(fmt::string_view(text.data(), text.size()), arguments);
  } catch (const fmt::format_error& error) {
    throw ReproduceError("the report cannot be written: a result is missing or has another type: " +
                         std::string(error.what()));
  }
}

std::string table(const Json& rows, const std::vector<Column>& columns) {
  std::ostringstream out;
  for (const Column& column : columns) out << "| " << column.head << ' ';
  out << "|\n";
  for (std::size_t i = 0; i < columns.size(); ++i) out << "|---";
  out << "|\n";
  for (const Json& row : rows) {
    for (const Column& column : columns) {
      const Json* const found = row.find(column.key);
      const bool number = found != nullptr && found->isNumber();
      out << "| "
          << (number ? fmt::format(fmt::runtime(column.format), column.factor * found->get<double>()) : "-")
          << ' ';
    }
    out << "|\n";
  }
  return out.str();
}

std::string withFolder(std::string text, const std::string& figures) {
  for (std::size_t at = text.find("(@"); at != std::string::npos; at = text.find("(@", at))
    text.replace(at + 1, 1, figures);
  return text;
}

}  // namespace palpate::reproduce
