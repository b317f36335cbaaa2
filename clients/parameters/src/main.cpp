// SPDX-License-Identifier: Apache-2.0
// palpate-parameters: changes what the hand feels while the server runs, or says what is in force.
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <optional>
#include <string>

#include "palpate/client/joining.h"
#include "palpate/client/parameter_exchange.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/printable.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/run.h"

namespace palpate::parameters {
namespace {

struct Options {
  LiveFields<std::optional<double>> values;
  std::uint32_t domain{0};
  std::filesystem::path security;
  std::optional<std::int64_t> server_id;
  std::optional<std::int64_t> organ_id;
  std::optional<int> tool;
  std::optional<std::string> model;
  double wait_s{10.0};
  bool json{false};
};

void addOptions(program::Options line, Options& options) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    line.add(info.option, &(options.values.*kLiveFields<LiveFields<std::optional<double>>>[i]),
             std::string(info.help) + "; default: stays as it is");
  }
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--tool", &options.tool, "change this tool only, 0 to 3; default: all of them").range(0, 3);
  line.add("--model", &options.model,
           "have the server answer with this model file from now on: a path within its folder of models "
           "(palpate-server --models)")
      .valueName("FILE");
  line.add("--server-id", &options.server_id, "which server of the domain; default: 0, or that of the organ");
  line.add("--organ-id", &options.organ_id, client::kOrganIdHelp).range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--wait", &options.wait_s, "how long to wait for an answer").range(0.0, 3600.0, "s");
  line.flag("--json", &options.json, "print one JSON object on standard output");
}

dds::ParameterRequest requestOf(const Options& options) {
  constexpr std::int64_t kMaxId = std::int64_t{dds::kServerAny} - 1;
  if (const std::int64_t id = options.server_id.value_or(0); id < 0 || id > kMaxId)
    throw program::UsageError("--server-id is " + std::to_string(id) + ", expected 0 to " +
                              std::to_string(kMaxId));
  dds::ParameterRequest request{};
  request.server_id = static_cast<std::uint32_t>(options.server_id.value_or(0));
  request.tool_id = options.tool ? static_cast<std::uint32_t>(*options.tool) : dds::kAllTools;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const std::optional<double>& value = options.values.*kLiveFields<LiveFields<std::optional<double>>>[i];
    if (!value) continue;
    request.fields |= kLiveParameters[i].bit;
    request.*kLiveFields<dds::ParameterRequest>[i] = *value;
  }
  if (options.model) dds::assignText(request.model, *options.model);
  return request;
}

// Addresses the server of an organ. @throw client::ClientError  there is none
void findOrgan(const dds::Participant& participant, const Options& options, dds::ParameterRequest& request) {
  client::WantedServer wanted;
  wanted.organ_id = options.organ_id;
  if (options.server_id) wanted.server_id = request.server_id;
  const client::ServerInfo found = client::findServer(participant, options.wait_s, wanted);
  request.server_id = found.status.server_id;
  request.session = found.status.session;
}

// What a request cannot hold. @throw program::UsageError
void checkModel(const Options& options, const dds::ParameterRequest& request) {
  if (!options.model) return;
  if (options.model->empty())
    throw program::UsageError("--model is empty, expected the name of a model file");
  if (options.model->size() >= sizeof request.model)
    throw program::UsageError("--model has " + std::to_string(options.model->size()) +
                              " characters, at most " + std::to_string(sizeof request.model - 1) +
                              " can be sent");
  if (request.fields != 0)
    throw program::UsageError("--model goes alone: give other values once the model is there");
}

// JSON has no infinity: null says "no bound".
void addTool(const dds::ToolParameters& tool, program::Json& json) {
  json["device"] = tool.device;
  json["tip_radius_m"] = tool.tip_radius;
  json["announced"] = tool.announced;
  json["refusal"] = tool.refusal;
  json["rendered_stiffness_N_per_m"] = tool.rendered_stiffness;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const auto field = kLiveFields<dds::LiveValues>[i];
    const char* const key = kLiveParameters[i].json;
    json[key] = tool.now.*field;
    json["limits"][key] = std::array{tool.lowest.*field, tool.highest.*field};
  }
}

// Values of the tool that was asked for, or of tool 0, and those of all.
program::Json jsonOf(const dds::ServerParameters& answer, std::size_t tool) {
  program::Json json{{"accepted", answer.accepted},
                     {"message", answer.message},
                     {"revision", answer.revision},
                     {"server_id", answer.server_id},
                     {"model_id", dds::printable(answer.model_id, sizeof answer.model_id)},
                     {"models", answer.models},
                     {"model_youngs_modulus_Pa", answer.model_youngs_modulus},
                     {"model_stiffness_N_per_m", answer.model_stiffness},
                     {"open", answer.open}};
  addTool(answer.tools[tool], json);
  for (const dds::ToolParameters& each : answer.tools) {
    program::Json entry;
    addTool(each, entry);
    json["tools"].push_back(entry);
  }
  return json;
}

void print(const dds::ServerParameters& answer, std::size_t shown) {
  const dds::ToolParameters& tool = answer.tools[shown];
  std::cout << "in force, revision " << answer.revision << ", tool " << shown << ", device " << tool.device
            << ", tip of " << tool.tip_radius << " m:\n";
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    const auto field = kLiveFields<dds::LiveValues>[i];
    std::cout << "  " << std::left << std::setw(20) << info.name << tool.now.*field;
    if (*info.unit != '\0') std::cout << " " << info.unit;
    if (answer.open) std::cout << ", may be " << tool.lowest.*field << " to " << tool.highest.*field;
    if (info.zero_is_models)
      std::cout << " (model: " << answer.model_youngs_modulus << " " << info.unit << ", there up to "
                << answer.model_stiffness << " N/m)";
    if (info.bit == dds::parameter::kCouplingStiffness && std::isfinite(tool.rendered_stiffness))
      std::cout << " (with the organ at most " << tool.rendered_stiffness << " N/m)";
    std::cout << "\n";
  }
  if (!answer.open) std::cout << "the server takes no changes from clients\n";
  std::cout << "model " << dds::printable(answer.model_id, sizeof answer.model_id)
            << (answer.models ? ", may be changed for another of the server's folder of models\n" : "\n");
}

int body(int argc, char** argv) {
  // 1. What to change.
  program::CommandLine line(
      "palpate-parameters",
      "Changes what the hand feels while a palpate-server runs, or says what is in force.");
  Options options;
  addOptions(line.options(), options);
  line.footer(
      "The server's operator sets which values are allowed; by default none above that of its start. Without "
      "values it says what is in force, and what is allowed.\n"
      "Example: palpate-parameters --friction 0.1 --youngs-modulus 5e4\n"
      "Example: palpate-parameters --model kidney.h5");
  if (!line.read(argc, argv)) return program::kDone;
  dds::ParameterRequest request = requestOf(options);
  checkModel(options, request);
  client::catchStopSignals();

  // 2. Ask, until the server answers.
  const dds::Participant participant = client::join(options.domain, options.security, {dds::Role::kOperator});
  if (options.organ_id) findOrgan(participant, options, request);
  const auto patience = std::chrono::milliseconds(static_cast<long>(options.wait_s * 1e3));
  std::cerr << "waiting for server " << request.server_id << " on DDS domain " << options.domain << "\n";
  const dds::ServerParameters answer = client::exchangeParameters(participant, request, patience);

  // 3. Tell.
  const auto tool = static_cast<std::size_t>(options.tool.value_or(0));
  if (options.json) {
    program::printJson(jsonOf(answer, tool));
  } else {
    print(answer, tool);
  }
  if (!answer.accepted)
    std::cerr << "palpate-parameters: refused, nothing has changed: "
              << dds::printable(answer.message, sizeof answer.message) << "\n";
  return answer.accepted ? program::kDone : program::kFailed;
}

}  // namespace
}  // namespace palpate::parameters

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-parameters", &palpate::parameters::body, argc, argv);
}
