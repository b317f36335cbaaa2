// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_certificate.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/model/meta_model.h"
#include "tools/modelfile/file_parts.h"
#include "tools/modelfile/model_data.h"
#include "tools/modelfile/write_model.h"
#include "tools/program/write_file.h"

namespace palpate::modelfile {

namespace {

/// Nobody else reads what is written there, before it has the mode of the file whose place it takes.
void makeEmpty(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
  const bool good = descriptor >= 0 && ::fchmod(descriptor, 0600) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw program::WriteError(path, std::strerror(error));
}

/// Of the checked arrays, so that HDF5 opens nothing here that another program made.
void writeCertified(const std::filesystem::path& file, const std::filesystem::path& to,
                    const std::string& certificate, const Digest& content) {
  const MetaModel model = MetaModel::load(file);
  if (model.digest() != content)
    throw ModelFileError("not certified: the certificate belongs to the content " + content.hex() +
                         ", the digest of this content is " + model.digest().hex());
  ModelAttributes attributes = model.attributes();
  attributes.certificate = certificate;
  writeModelTo(to, attributes, model.view(), isCompact(model.view()));
}

/// @param file  no symbolic link: it would be replaced, and not what it leads to
void replaceFile(const std::filesystem::path& file, const std::string& certificate, const Digest& content) {
  const std::filesystem::perms mode = std::filesystem::status(file).permissions();
  program::FileBeside beside(file);
  makeEmpty(beside.path());
  writeCertified(file, beside.path(), certificate, content);
  (void)MetaModel::load(beside.path());  // refuses a certificate that no reader takes
  std::filesystem::permissions(beside.path(), mode);
  sync(beside.path());
  beside.takePlace();
  syncFolder(file);
}

}  // namespace

void writeCertificate(const std::filesystem::path& path, const std::string& certificate,
                      const Digest& content) {
  try {
    replaceFile(std::filesystem::canonical(path), certificate, content);
  } catch (const std::filesystem::filesystem_error& error) {
    throw ModelFileError(path.string() + ": cannot be written: " + error.code().message());
  } catch (const LoadError& error) {
    throw ModelFileError(path.string() + ": not certified: " + error.what());
  } catch (const program::WriteError& error) {
    throw ModelFileError(path.string() + ": cannot be written: " + error.reason());
  } catch (const ModelFileError& error) {
    throw ModelFileError(path.string() + ": " + error.what());
  }
}

}  // namespace palpate::modelfile
