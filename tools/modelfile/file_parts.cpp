// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/file_parts.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>

#include "core/data/datasets.h"
#include "core/data/sha256.h"
#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

void require(bool good, const std::string& what) {
  if (!good) throw ModelFileError("cannot write " + what);
}

Hdf5Handle aligned() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(access.valid() && H5Pset_alignment(access.get(), 0, kArrayAlignment) >= 0, "aligned arrays");
  return access;
}

void writeText(const Hdf5Handle& file, const char* name, const std::string& text) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(type.valid() && H5Tset_size(type.get(), H5T_VARIABLE) >= 0, name);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Hdf5Handle attribute(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const char* const start = text.c_str();
  require(attribute.valid() && H5Awrite(attribute.get(), type.get(), &start) >= 0, name);
}

void writeWithDigest(const Hdf5Handle& file, const std::string& name, const std::string& text) {
  writeText(file, name.c_str(), text);
  writeText(file, (name + "_digest").c_str(), sha256(std::as_bytes(std::span<const char>(text))).hex());
}

void writeCertificateTexts(const Hdf5Handle& file, const std::string& certificate,
                           const std::string& content) {
  writeWithDigest(file, "certificate", certificate);
  writeText(file, "certificate_of", content);
}

void sync(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw ModelFileError(path.string() + " cannot be synced: " + std::strerror(error));
}

void syncFolder(const std::filesystem::path& path) {
  sync(path.has_parent_path() ? path.parent_path() : ".");
}

}  // namespace palpate::modelfile
