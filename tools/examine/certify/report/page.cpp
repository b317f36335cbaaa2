// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/page.h"

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "tools/examine/certify/report/page_template.h"

namespace palpate::certify {

namespace {

namespace mustache = kainjow::mustache;
using program::Json;

std::string cleaned(std::string text) {
  const auto isControl = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
  };
  std::replace_if(text.begin(), text.end(), isControl, '?');
  return text;
}

mustache::data dataOf(const Json& json) {
  if (json.isString()) return mustache::data(cleaned(json.text()));
  if (json.isBool()) return mustache::data(json.get<bool>());
  if (json.isArray()) {
    mustache::data list(mustache::data::type::list);
    for (const Json& entry : json) list.push_back(dataOf(entry));
    return list;
  }
  mustache::data object(mustache::data::type::object);
  for (const auto& [key, value] : json.members()) object.set(key, dataOf(value));
  return object;
}

}  // namespace

std::string pageOf(const Json& view) {
  mustache::mustache page{std::string(kPageTemplate)};
  if (!page.is_valid()) throw std::logic_error("page.html: " + page.error_message());
  return page.render(dataOf(view));
}

}  // namespace palpate::certify
