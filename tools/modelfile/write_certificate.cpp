// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_certificate.h"

#include <hdf5.h>

#include "core/data/hdf5_handle.h"
#include "core/model/meta_model.h"
#include "tools/modelfile/file_parts.h"
#include "tools/modelfile/model_data.h"
#include "tools/program/write_file.h"

namespace palpate::modelfile {

namespace {

void replaceTexts(const std::filesystem::path& path, const std::string& certificate, const Digest& content) {
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, aligned().get()), H5Fclose);
  require(file.valid(), path);
  for (const char* name : {"certificate", "certificate_digest", "certificate_of"})
    if (H5Aexists(file.get(), name) > 0) require(H5Adelete(file.get(), name) >= 0, name);
  writeCertificateTexts(file, certificate, content.hex());
  require(file.closeNow(), path);
}

/// @param file  no symbolic link: it would be replaced, and not what it leads to
void replaceFile(const std::filesystem::path& file, const std::string& certificate, const Digest& content) {
  using std::filesystem::perms;
  program::FileBeside beside(file);
  // What a process of the same number left behind is of no use.
  std::filesystem::copy_file(file, beside.path(), std::filesystem::copy_options::overwrite_existing);
  const perms mode = std::filesystem::status(file).permissions();
  std::filesystem::permissions(beside.path(), mode | perms::owner_read | perms::owner_write);
  replaceTexts(beside.path(), certificate, content);
  (void)MetaModel::load(beside.path());  // refuses it where the file became another one meanwhile
  std::filesystem::permissions(beside.path(), mode);
  sync(beside.path());
  beside.takePlace();
  syncFolder(file);
}

}  // namespace

void writeCertificate(const std::filesystem::path& path, const std::string& certificate,
                      const Digest& content) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors leave as exceptions, not as HDF5's own print-out
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
