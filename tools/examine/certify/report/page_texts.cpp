// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/page_texts.h"

#include "tools/program/printed.h"

namespace palpate::certify {

using program::Json;
using program::printed;

std::string percent(const Json& share) {
  return share.isNumber() ? printed("%.3g %%", 100.0 * share.get<double>()) : "unknown";
}

std::string millimetres(const Json& length) {
  return printed("%.4g mm", 1e3 * length.get<double>());
}

std::string known(const Json& text) {
  return text.isString() && !text.text().empty() ? text.text() : "unknown";
}

std::string countText(const Json& count) {
  return printed("%llu", count.get<unsigned long long>());
}

}  // namespace palpate::certify
