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

}  // namespace

void writeCertificate(const std::filesystem::path& path, const std::string& certificate,
                      const Digest& content) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors leave as exceptions, not as HDF5's own print-out
  program::FileBeside beside(path);
  try {
    std::filesystem::copy_file(path, beside.path());
    replaceTexts(beside.path(), certificate, content);
    (void)MetaModel::load(beside.path());  // refuses it where the file became another one meanwhile
    sync(beside.path());
    beside.takePlace();
    syncFolder(path);
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
