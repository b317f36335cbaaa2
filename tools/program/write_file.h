// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>

namespace palpate::program {

/// A file that cannot be written. what() is "cannot write PATH: REASON".
class WriteError : public std::runtime_error {
 public:
  WriteError(const std::filesystem::path& path, const std::string& reason)
      : std::runtime_error("cannot write " + path.string() + ": " + reason), reason_(reason) {}
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

 private:
  std::string reason_;
};

/// A file beside its target, "TARGET.tmp-PID", that takes the target's place when it is whole: a reader sees the old
/// file or the new one. What did not take the place is removed.
class FileBeside {
 public:
  explicit FileBeside(std::filesystem::path target);
  ~FileBeside();
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// @throw WriteError naming the target
  void takePlace();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  bool placed_{false};
};

/// Writes a file beside its target and puts it in place. @param[in] write  fills the stream  @throw WriteError
void writeFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void writeFile(const std::filesystem::path& path, const std::string& content);

/// Before the work whose result it takes: the file's folder is there and can be written, and the file is not a folder.
/// @throw WriteError
void checkWritable(const std::filesystem::path& file);

/// The same of an option's value, which may be empty: then nothing is written.
/// @param[in] option  "--plot"  @throw UsageError "--plot: cannot write PATH: REASON"
void checkOutput(const std::string& option, const std::filesystem::path& file);

/// The same of a folder, which is made when it is not there, with its parents: the innermost of them that is there is a folder
/// and can be written. @throw UsageError
void checkOutputFolder(const std::string& option, const std::filesystem::path& folder);

/// Whether two paths lead to one file, which need not be there: through links, or by "..".
[[nodiscard]] bool isSameFile(const std::filesystem::path& one, const std::filesystem::path& other);

}  // namespace palpate::program
