#include "cellocut/base/atomic_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>

#include "cellocut/base/errors.h"

namespace cellocut {
namespace {

// The names of all temporary files, where a signal handler can read them: no memory is allocated or
// freed, and a name is complete before its slot says so.
struct Slot {
  enum State : int { free, taken, armed };
  std::atomic<int> state{free};
  std::array<char, PATH_MAX> name{};
};
static_assert(std::atomic<int>::is_always_lock_free);
constexpr int kSlotCount = 64;
std::array<Slot, kSlotCount> slots;

// -1 where all slots are taken.
int take_slot() {
  for (int i = 0; i < kSlotCount; ++i) {
    int expected = Slot::free;
    if (slots[i].state.compare_exchange_strong(expected, Slot::taken)) return i;
  }
  return -1;
}

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return "";
  return path.substr(0, slash + 1);
}

// The descriptor that a name such as /dev/stdout or /dev/fd/3 stands for, or -1. Opening such a
// name anew would begin at the start of the file, and renaming over it would take the file away
// from the shell.
int descriptor_of_name(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (path.compare(0, prefix.size(), prefix) != 0) continue;
    int number = -1;
    const char* end = path.data() + path.size();
    const auto result = std::from_chars(path.data() + prefix.size(), end, number);
    if (result.ec == std::errc() && result.ptr == end && number >= 0) return number;
  }
  return -1;
}

// What a chain of symbolic links ends in, which need not exist. Returns errno, or 0.
int follow_links(std::string& path) {
  constexpr int kMostLinks = 40;  // as the system allows
  for (int i = 0; i < kMostLinks; ++i) {
    std::array<char, PATH_MAX> link;
    const ssize_t length = ::readlink(path.c_str(), link.data(), link.size());
    if (length < 0) return 0;  // not a link: where something else is wrong, opening will say it
    const std::string next(link.data(), static_cast<std::size_t>(length));
    path = next.front() == '/' ? next : folder_of(path) + next;
  }
  return ELOOP;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(path_) {
  buffer_.reserve(kBufferSize);
  if (path_ == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  if (const int named = descriptor_of_name(path_); named >= 0) {
    descriptor_ = ::fcntl(named, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail("cannot open", errno);
    return;
  }
  struct stat status {};
  const bool exists = ::stat(path_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail("cannot write", EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot open", errno);
    return;
  }
  // A rename would replace a write-protected file without asking.
  if (exists && ::faccessat(AT_FDCWD, path_.c_str(), W_OK, AT_EACCESS) != 0) {
    fail("cannot write", errno);
  }
  if (const int error = follow_links(target_); error != 0) fail("cannot open", error);
  if (target_.empty() || target_.back() == '/')
    fail("cannot create", target_.empty() ? ENOENT : EISDIR);
  create_temporary();
  if (exists && ::fchmod(descriptor_, status.st_mode & 07777) != 0) {
    const int error = errno;
    discard();
    fail("cannot set the permissions", error);
  }
}

AtomicFile::~AtomicFile() { discard(); }

// A name of its own beside the target, short whatever the target's name is.
void AtomicFile::create_temporary() {
  static std::atomic<std::uint64_t> counter{0};
  const std::string folder = folder_of(target_);
  slot_ = take_slot();
  if (slot_ < 0) fail("cannot create: too many output files at once", EMFILE);
  Slot& slot = slots[slot_];
  int error = EEXIST;
  for (int attempt = 0; attempt < 1000 && error == EEXIST; ++attempt) {
    temporary_ = folder + ".cellocut-" + std::to_string(::getpid()) + "-" +
                 std::to_string(counter.fetch_add(1)) + ".tmp";
    if (temporary_.size() >= slot.name.size()) {
      error = ENAMETOOLONG;
      break;
    }
    std::memcpy(slot.name.data(), temporary_.c_str(), temporary_.size() + 1);
    slot.state.store(Slot::armed);  // before the file exists: no signal may find it unlisted
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    error = errno;
    slot.state.store(Slot::taken);
  }
  slot.state.store(Slot::free);
  slot_ = -1;
  temporary_.clear();
  fail(folder.empty() ? "cannot create a file in the current folder"
                      : "cannot create a file in '" + folder + "'",
       error);
}

void AtomicFile::write(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  if (buffer_.size() + size > kBufferSize) flush();
  if (size >= kBufferSize) {
    write_all(bytes, size);
  } else {
    buffer_.insert(buffer_.end(), bytes, bytes + size);
  }
}

void AtomicFile::flush() {
  write_all(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::write_all(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, data, size);
    if (written >= 0) {
      data += written;
      size -= static_cast<std::size_t>(written);
    } else if (errno == EAGAIN) {  // a pipe that somebody set to non-blocking
      pollfd ready{descriptor_, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      fail("cannot write", errno);
    }
  }
}

void AtomicFile::commit() {
  flush();
  if (temporary_.empty()) {
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor > STDERR_FILENO && ::close(descriptor) != 0) fail("cannot write", errno);
    return;
  }
  // Some file systems report a full disk only now. Where they cannot sync at all, that is no error.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOSYS && errno != ENOTSUP) {
    fail("cannot write", errno);
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot write", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename", errno);
  temporary_.clear();
  slots[slot_].state.store(Slot::free);
  slot_ = -1;
}

void AtomicFile::discard() noexcept {
  if (descriptor_ > STDERR_FILENO) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  if (slot_ >= 0) slots[slot_].state.store(Slot::free);
  slot_ = -1;
}

void AtomicFile::remove_all_temporaries() noexcept {
  const int error = errno;
  for (const Slot& slot : slots) {
    if (slot.state.load() == Slot::armed) ::unlink(slot.name.data());
  }
  errno = error;
}

void AtomicFile::fail(const std::string& what, int error) {
  throw OutputError(what + ": " + std::strerror(error), path_);
}

}  // namespace cellocut
