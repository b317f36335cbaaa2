// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include "palpate/server/config.h"
#include "palpate/server/parameter_book.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

constexpr std::array kDevices{"touch", "omni", "desktop", "premium15", "premium30", "custom"};

server::Facts factsOf(const std::string& device, bool open) {
  server::Facts facts;
  facts.server_id = 6;
  facts.device.fill(device);
  facts.step = server::withDevice({}, device, {});
  facts.organ = {160e3, 4200.0};
  facts.step.organ_stiffness = facts.organ.largest;
  facts.parameters = open;
  return facts;
}

// A number that parameters have, or any bits.
double number(Source& source) {
  constexpr std::array kSome{0.0,
                             -0.0,
                             -1.0,
                             0.5,
                             1.0,
                             2.0,
                             3.3,
                             1e3,
                             1e5,
                             1e300,
                             -1e300,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  const auto form = source.get<std::uint8_t>();
  return form < kSome.size() ? kSome[form] : form < 128 ? form * 0.01 : source.get<double>();
}

dds::ParameterRequest request(Source& source) {
  dds::ParameterRequest asked{};
  asked.tool_id = source.get<std::uint8_t>();
  if (asked.tool_id > 5) asked.tool_id = dds::kAllTools;
  asked.fields = source.get<std::uint8_t>();
  for (const auto field : kLiveFields<dds::ParameterRequest>) asked.*field = number(source);
  return asked;
}

dds::ToolAnnouncement announcement(Source& source) {
  dds::ToolAnnouncement said{};
  const auto form = source.get<std::uint8_t>();
  dds::assignText(said.device, form < kDevices.size() ? kDevices[form] : source.text(form % 40));
  said.device_force_limit = number(source);
  said.has_tip_radius = form % 2 == 0;
  said.tip_radius = number(source);
  said.fields = source.get<std::uint8_t>();
  for (const auto field : kLiveFields<dds::LiveValues>) said.values.*field = number(source);
  return said;
}

// Whatever was asked for, what is in force is in its range and within the limits that the answer states.
void look(const server::ParameterBook& book) {
  for (const ToolSettings& settings : book.inForce())
    require(!firstComplaint(settings), "what is in force is in its range");
  const dds::ServerParameters answer = book.answer();
  for (const dds::ToolParameters& tool : answer.tools)
    for (const auto field : kLiveFields<dds::LiveValues>) {
      if (field == &dds::LiveValues::coupling_stiffness)
        continue;  // as felt: softer where it follows the organ
      require(tool.lowest.*field <= tool.now.*field && tool.now.*field <= tool.highest.*field,
              "what is in force is within the limits");
    }
}

}  // namespace

bool parameters(Bytes input) {
  Source source(input);
  const auto form = source.get<std::uint8_t>();
  server::ParameterBook book(factsOf(kDevices[form % kDevices.size()], form < 128));
  bool accepted = false;
  std::uint64_t words = 0, revision = 0;
  while (!source.empty()) {
    const auto what = source.get<std::uint8_t>();
    if (what % 4 == 0) {
      const std::size_t tool = what / 4 % kMaxTools;
      std::optional<server::DriverWord> said;
      if (what < 224) {
        said.emplace(server::DriverWord{++words, {}, announcement(source)});
        said->by.fill(what % 3);
      }
      (void)book.announced(tool, said);
      accepted = accepted || (said && book.refusal(tool).empty());
    } else if (what % 16 == 1) {
      const OrganStiffness organ{1e3 * (1 + source.get<std::uint8_t>()),
                                 10.0 * (1 + source.get<std::uint8_t>())};
      if (book.complaintAbout(organ).empty()) book.take(organ);
    } else {
      const dds::ServerParameters answer = book.decide(request(source));
      require(answer.accepted == (answer.message[0] == '\0'), "a refusal says why");
      accepted = accepted || answer.accepted;
    }
    require(book.revision() >= revision, "revisions rise");
    revision = book.revision();
    look(book);
  }
  (void)book.describe();
  return accepted;
}

}  // namespace palpate::fuzz
