// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/models_folder.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/data/load_error.h"
#include "palpate/idl/printable.h"
#include "palpate/server/config.h"

namespace palpate::server {
namespace {

// The kernel keeps every step of the way within the folder, links included. glibc of Debian 12 has no function for it.
int openBeneath(int folder, const std::string& name) {
  constexpr int kAttempts = 100;  // EAGAIN: something was renamed on the way
  open_how how{};
  how.flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK;  // a pipe must not block us
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  long descriptor = -1;
  for (int i = 0; i < kAttempts; ++i) {
    descriptor = ::syscall(SYS_openat2, folder, name.c_str(), &how, sizeof how);
    if (descriptor >= 0 || (errno != EAGAIN && errno != EINTR)) break;
  }
  return static_cast<int>(descriptor);
}

std::string reasonOf(int error) {
  if (error == EXDEV) return "leads out of the server's folder of models";
  if (error == ENOENT || error == ENOTDIR) return "is not in the server's folder of models";
  if (error == ENOSYS || error == EPERM)
    return "cannot be opened: this system cannot keep within a folder (openat2, Linux 5.6)";
  return std::string("cannot be opened: ") + std::strerror(error);
}

}  // namespace

ModelsFolder::ModelsFolder(const std::filesystem::path& path)
    : descriptor_(::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw ConfigError("the folder of models, " + path.string() +
                      ", cannot be opened: " + std::strerror(errno));
}

ModelsFolder::~ModelsFolder() {
  ::close(descriptor_);
}

std::string ModelsFolder::complaintAbout(const std::string& name) {
  const std::string shown = "model \"" + dds::printable(name.c_str()) + "\" ";
  if (std::any_of(name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }))
    return shown + "holds a character that is not printable";
  const std::filesystem::path path(name);
  if (name.empty() || path.is_absolute())
    return shown + "is no path relative to the server's folder of models";
  if (std::find(path.begin(), path.end(), "..") != path.end())
    return shown + "holds \"..\", expected a path within the server's folder of models";
  return {};
}

int ModelsFolder::open(const std::string& name) const {
  const std::string complaint = complaintAbout(name);
  if (!complaint.empty()) throw LoadError(complaint);
  const int descriptor = openBeneath(descriptor_, name);
  if (descriptor < 0) throw LoadError("model \"" + name + "\" " + reasonOf(errno));
  return descriptor;
}

}  // namespace palpate::server
