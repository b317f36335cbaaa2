// SPDX-License-Identifier: Apache-2.0
// palpate-parameters: changes what the hand feels while the server runs, or says what is in force.
#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>

#include "exchange.h"
#include "palpate/client/stop_signal.h"
#include "palpate/report/program.h"

namespace palpate::parameters {
namespace {

struct Options {
  std::optional<double> youngs_modulus;
  std::optional<double> friction;
  std::optional<double> coupling_stiffness;
  std::optional<double> coupling_damping;
  std::optional<double> force_limit;
  std::optional<double> force_rate_limit;
  std::uint32_t domain{0};
  std::uint32_t server_id{0};
  double wait_s{10.0};
  bool json{false};
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("--youngs-modulus", options.youngs_modulus,
                 "stiffness E of the organ, Pa, 100 to 1e9; 0: the model's own");
  app.add_option("--friction", options.friction, "Coulomb coefficient, 0 to 2 or inf");
  app.add_option("--coupling", options.coupling_stiffness,
                 "stiffness of the virtual coupling, N/m, 1 to what the server's device stands");
  app.add_option("--coupling-damping", options.coupling_damping,
                 "its damping, N s/m, 0 to 100 and at most 5 ms of its stiffness");
  app.add_option("--force-limit", options.force_limit,
                 "largest force, N, 0.01 to what the server's device allows");
  app.add_option("--force-rate-limit", options.force_rate_limit,
                 "largest change of the force, N/s, 10 to what the server started with");
  app.add_option("--domain", options.domain, "DDS domain")->check(CLI::Range(0, 230))->capture_default_str();
  app.add_option("--server-id", options.server_id, "which server of the domain")->capture_default_str();
  app.add_option("--wait", options.wait_s, "how long to wait for an answer, s")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print one JSON object on standard output");
  app.set_version_flag("--version", PALPATE_VERSION);
  app.footer(
      "Example: palpate-parameters --friction 0.1 --youngs-modulus 5e4\nWithout values: says what is in "
      "force.");
}

dds::ParameterRequest requestOf(const Options& options) {
  dds::ParameterRequest request{};
  request.server_id = options.server_id;
  const auto set = [&](std::uint32_t bit, const std::optional<double>& from, double& to) {
    if (!from) return;
    request.fields |= bit;
    to = *from;
  };
  set(dds::parameter::kYoungsModulus, options.youngs_modulus, request.youngs_modulus);
  set(dds::parameter::kFriction, options.friction, request.friction);
  set(dds::parameter::kCouplingStiffness, options.coupling_stiffness, request.coupling_stiffness);
  set(dds::parameter::kCouplingDamping, options.coupling_damping, request.coupling_damping);
  set(dds::parameter::kForceLimit, options.force_limit, request.force_limit);
  set(dds::parameter::kForceRateLimit, options.force_rate_limit, request.force_rate_limit);
  return request;
}

// JSON has no infinity: null says "no bound".
nlohmann::json jsonOf(const dds::ServerParameters& answer) {
  return {{"accepted", answer.accepted},
          {"message", answer.message},
          {"revision", answer.revision},
          {"server_id", answer.server_id},
          {"youngs_modulus_Pa", answer.youngs_modulus},
          {"model_youngs_modulus_Pa", answer.model_youngs_modulus},
          {"friction", answer.friction},
          {"coupling_N_per_m", answer.coupling_stiffness},
          {"coupling_damping_Ns_per_m", answer.coupling_damping},
          {"force_limit_N", answer.force_limit},
          {"force_rate_limit_N_per_s", answer.force_rate_limit}};
}

void print(const dds::ServerParameters& answer) {
  std::cout << "in force, revision " << answer.revision << ":\n"
            << "  E                 " << answer.youngs_modulus
            << " Pa (model: " << answer.model_youngs_modulus << " Pa)\n"
            << "  friction          " << answer.friction << "\n"
            << "  coupling          " << answer.coupling_stiffness << " N/m, " << answer.coupling_damping
            << " N s/m\n"
            << "  force limit       " << answer.force_limit << " N, " << answer.force_rate_limit << " N/s\n";
}

int body(int argc, char** argv) {
  // 1. What to change.
  CLI::App app("Changes what the hand feels while a palpate-server runs, or says what is in force.");
  Options options;
  addOptions(app, options);
  CLI11_PARSE(app, argc, argv);
  client::catchStopSignals();

  // 2. Ask, until the server answers.
  const dds::Participant participant(options.domain);
  const auto patience = std::chrono::milliseconds(static_cast<long>(options.wait_s * 1e3));
  const dds::ServerParameters answer = exchange(participant, requestOf(options), patience);

  // 3. Tell.
  if (options.json) {
    report::printJson(jsonOf(answer));
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
  return palpate::report::runProgram("palpate-parameters", &palpate::parameters::body, argc, argv);
}
