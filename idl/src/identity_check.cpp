// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/identity_check.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"

namespace palpate::dds {
namespace {

namespace fs = std::filesystem;

std::string octal(mode_t mode) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04o", mode & 07777U);
  return text.data();
}

struct stat statusOf(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return status;
  const int error = errno;
  throw DdsError(path.string() + ": " + std::strerror(error) +
                 (error == EACCES ? "; chown -R its folder to the user who runs this program" : ""));
}

void checkOwner(const fs::path& path, const struct stat& status, Others others, const char* owners_mode) {
  if (status.st_uid != geteuid() && status.st_uid != 0)
    throw DdsError(path.string() + ": belongs to user " + std::to_string(status.st_uid) +
                   ", expected the user who runs this program, or root; chown -R its folder");
  const bool nothing = others == Others::kNothing;
  if ((status.st_mode & (nothing ? S_IRWXG | S_IRWXO : S_IWGRP | S_IWOTH)) != 0)
    throw DdsError(path.string() + ": mode is " + octal(status.st_mode) + ", others may " +
                   (nothing ? "read" : "write") + " it; chmod " + (nothing ? owners_mode : "go-w") + " " +
                   path.string());
}

}  // namespace

void checkFile(const fs::path& file, Others others) {
  const struct stat status = statusOf(file);
  if (!S_ISREG(status.st_mode)) throw DdsError(file.string() + ": not a file");
  checkOwner(file, status, others, "600");
}

void checkFolder(const fs::path& folder, Others others) {
  const struct stat status = statusOf(folder);
  if (!S_ISDIR(status.st_mode)) throw DdsError(folder.string() + ": not a folder");
  checkOwner(folder, status, others, "700");
}

void checkTimes(const fs::path& file, std::time_t start, std::time_t end, const std::string& remedy) {
  const std::time_t now = std::time(nullptr);
  if (now < start)
    throw DdsError(file.string() + ": valid from " + utcOf(start) + " on; is the clock right?");
  if (now >= end) throw DdsError(file.string() + ": expired on " + utcOf(end) + "; " + remedy);
}

}  // namespace palpate::dds
