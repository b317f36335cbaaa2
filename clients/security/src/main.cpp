// SPDX-License-Identifier: Apache-2.0
// palpate-security: who may do what on a DDS domain whose topics are signed and encrypted. docs/security.md.
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "authority.h"
#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"
#include "palpate/idl/identity.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/run.h"

namespace palpate::security {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path folder{"security"};
  std::string role, name;
  int authority_days{3650}, days{365};
  bool renew{false}, json{false};
};

struct Commands {
  program::Options init, issue, check;
};

Commands addCommands(program::Options line, Arguments& arguments) {
  Commands commands{
      line.subcommand("init", "make an authority: what all machines of an installation trust"),
      line.subcommand("issue", "make an identity, a folder that programs take as --security"),
      line.subcommand("check",
                      "say what is valid and until when: of an authority and all that it issued, or of one "
                      "identity; ends with 3 where something is not")};
  for (program::Options* command : {&commands.init, &commands.issue, &commands.check})
    command->add("--folder", &arguments.folder, "the authority's folder").valueName("FOLDER");
  commands.init.add("--days", &arguments.authority_days, "how long it is valid").range(1, 36500);
  commands.init.example("palpate-security init --folder security");
  commands.issue
      .add("role", &arguments.role,
           "server: answers poses; driver: sends poses and says what its device is; viewer: reads only; "
           "operator: sets "
           "parameters, and sends poses from a page")
      .required()
      .oneOf({"server", "driver", "viewer", "operator"});
  commands.issue.add("name", &arguments.name, "names it, e.g. by its machine").required();
  commands.issue.add("--days", &arguments.days, "how long it is valid").range(1, 3650);
  commands.issue.flag("--renew", &arguments.renew, "replace an identity of that name, with another key");
  commands.issue.example("palpate-security issue driver touch-1");
  commands.check.flag("--json", &arguments.json, "print one JSON object on standard output");
  commands.check.example("palpate-security check --folder security");
  return commands;
}

struct Verdict {
  fs::path folder;
  std::string role, name;
  std::time_t expires{0};
  std::string problem;  // empty: valid
  std::string warning;  // empty: more than 30 days left
};

Verdict judge(const fs::path& folder) {
  Verdict verdict{folder, {}, {}, 0, {}, {}};
  try {
    const dds::Identity identity = dds::Identity::load(folder);
    verdict.role = dds::wordOf(identity.role());
    verdict.name = identity.name();
    verdict.expires = identity.expires();
    verdict.warning = identity.warning();
  } catch (const dds::DdsError& error) {
    verdict.problem = error.what();
  }
  return verdict;
}

Verdict judgeAuthority(const fs::path& folder) {
  Verdict verdict{folder, {}, {}, 0, {}, {}};
  try {
    verdict.expires = checkAuthority(folder);
    verdict.role = "authority";
    verdict.name = folder.string();
  } catch (const dds::DdsError& error) {
    verdict.problem = error.what();
  }
  return verdict;
}

// An authority first, then what it issued, by name. What begins with a dot is about to become one.
std::vector<Verdict> judgeAll(const fs::path& folder) {
  if (!fs::exists(folder / kIssued)) return {judge(folder)};
  std::vector<Verdict> verdicts;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kIssued))
    if (entry.is_directory() && entry.path().filename().string().front() != '.')
      verdicts.push_back(judge(entry.path()));
  std::sort(verdicts.begin(), verdicts.end(),
            [](const Verdict& a, const Verdict& b) { return a.folder < b.folder; });
  verdicts.insert(verdicts.begin(), judgeAuthority(folder));
  return verdicts;
}

program::Json jsonOf(const std::vector<Verdict>& verdicts, bool valid) {
  program::Json identities = program::Json::array();
  for (const Verdict& v : verdicts)
    identities.push_back({{"folder", v.folder.string()},
                          {"role", v.role},
                          {"name", v.name},
                          {"expires", v.expires == 0 ? std::string() : dds::utcOf(v.expires)},
                          {"valid", v.problem.empty()},
                          {"problem", v.problem},
                          {"warning", v.warning}});
  return {{"valid", valid}, {"identities", identities}};
}

int check(const Arguments& arguments) {
  if (!fs::is_directory(arguments.folder))
    throw SecurityError(arguments.folder.string() + ": no such folder");
  const std::vector<Verdict> verdicts = judgeAll(arguments.folder);
  const bool valid =
      std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.problem.empty(); });
  if (arguments.json) {
    program::printJson(jsonOf(verdicts, valid));
    return valid ? program::kDone : program::kNotHeld;
  }
  for (const Verdict& v : verdicts) {
    if (v.problem.empty())
      std::cout << "valid until " << dds::utcOf(v.expires) << "  " << v.role << " " << v.name << "\n";
    else
      std::cout << "NOT VALID  " << v.problem << "\n";
    if (!v.warning.empty()) std::cout << "  warning: " << v.warning << "\n";
  }
  return valid ? program::kDone : program::kNotHeld;
}

int body(int argc, char** argv) {
  program::CommandLine line(
      "palpate-security",
      "Makes authority, identities and permissions for DDS topics that are signed and encrypted.");
  Arguments arguments;
  const Commands commands = addCommands(line.options(), arguments);
  line.options().example("palpate-security init --folder security");
  if (!line.read(argc, argv)) return program::kDone;
  if (commands.init.chosen()) {
    makeAuthority(arguments.folder, {arguments.authority_days});
    std::cout << arguments.folder.string() << ": an authority. Keep "
              << (arguments.folder / kPrivate).string() << " on this machine: who has it lets anybody in\n";
    return program::kDone;
  }
  if (commands.check.chosen()) return check(arguments);
  const Issued made = issue(arguments.folder, *dds::roleOf(arguments.role), arguments.name, {arguments.days},
                            arguments.renew);
  std::cout << made.folder.string() << ": valid until " << dds::utcOf(made.end)
            << (made.cut ? ", when its authority ends" : "")
            << "; copy it to its machine, as that program's user, and start the program with --security "
            << "FOLDER\n";
  return program::kDone;
}

}  // namespace
}  // namespace palpate::security

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-security", &palpate::security::body, argc, argv);
}
