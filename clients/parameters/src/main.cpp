// SPDX-License-Identifier: Apache-2.0
// palpate-parameters: changes what the hand feels while the server runs, or says what is in force.
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <optional>
#include <string>

#include "exchange.h"
#include "palpate/client/stop_signal.h"
#include "palpate/program/command_line.h"
#include "palpate/program/json.h"
#include "palpate/program/run.h"

namespace palpate::parameters {
namespace {

struct Options {
  LiveFields<std::optional<double>> values;
  std::uint32_t domain{0};
  std::uint32_t server_id{0};
  double wait_s{10.0};
  bool json{false};
};

void addOptions(program::Options line, Options& options) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    line.add(info.option, &(options.values.*kLiveFields<LiveFields<std::optional<double>>>[i]), info.help);
  }
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--server-id", &options.server_id, "which server of the domain");
  line.add("--wait", &options.wait_s, "how long to wait for an answer, s").range(0.0, 3600.0);
  line.flag("--json", &options.json, "print one JSON object on standard output");
}

dds::ParameterRequest requestOf(const Options& options) {
  dds::ParameterRequest request{};
  request.server_id = options.server_id;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const std::optional<double>& value = options.values.*kLiveFields<LiveFields<std::optional<double>>>[i];
    if (!value) continue;
    request.fields |= kLiveParameters[i].bit;
    request.*kLiveFields<dds::ParameterRequest>[i] = *value;
  }
  return request;
}

// JSON has no infinity: null says "no bound".
program::Json jsonOf(const dds::ServerParameters& answer) {
  program::Json json{{"accepted", answer.accepted},
                     {"message", answer.message},
                     {"revision", answer.revision},
                     {"server_id", answer.server_id},
                     {"model_youngs_modulus_Pa", answer.model_youngs_modulus}};
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    json[kLiveParameters[i].json] = answer.*kLiveFields<dds::ServerParameters>[i];
  return json;
}

void print(const dds::ServerParameters& answer) {
  std::cout << "in force, revision " << answer.revision << ":\n";
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    std::cout << "  " << std::left << std::setw(20) << info.name
              << answer.*kLiveFields<dds::ServerParameters>[i];
    if (*info.unit != '\0') std::cout << " " << info.unit;
    if (info.zero_is_models)
      std::cout << " (model: " << answer.model_youngs_modulus << " " << info.unit << ")";
    std::cout << "\n";
  }
}

int body(int argc, char** argv) {
  // 1. What to change.
  program::CommandLine line(
      "palpate-parameters",
      "Changes what the hand feels while a palpate-server runs, or says what is in force.");
  Options options;
  addOptions(line.options(), options);
  line.footer(
      "The server's device and start may allow less coupling, force and change of force.\n"
      "Example: palpate-parameters --friction 0.1 --youngs-modulus 5e4\nWithout values: says what is in "
      "force.");
  if (!line.read(argc, argv)) return 0;
  client::catchStopSignals();

  // 2. Ask, until the server answers.
  const dds::Participant participant(options.domain);
  const auto patience = std::chrono::milliseconds(static_cast<long>(options.wait_s * 1e3));
  const dds::ServerParameters answer = exchange(participant, requestOf(options), patience);

  // 3. Tell.
  if (options.json) {
    program::printJson(jsonOf(answer));
  } else {
    print(answer);
  }
  if (!answer.accepted)
    std::cerr << "palpate-parameters: refused, nothing has changed: " << answer.message << "\n";
  return answer.accepted ? 0 : 1;
}

}  // namespace
}  // namespace palpate::parameters

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-parameters", &palpate::parameters::body, argc, argv);
}
