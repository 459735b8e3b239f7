#include "cli/memory_option.h"

#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/global_new.h"
#include "cli/text.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

namespace crease::cli {

namespace {

// What on_lost_page() prints: it may not put anything together.
std::string lost_page_line, lost_page_json;

void print_now(int descriptor, const std::string& text) {
  [[maybe_unused]] const ssize_t written = ::write(descriptor, text.data(), text.size());
}

// A page of the file that the disk cannot take or give. Work cannot go on without it, and nothing
// is to be cleaned up: the file has no name.
void on_lost_page(int, siginfo_t* signal, void*) {
  const MemoryLimit* limit = memory_limit();
  if (limit != nullptr && limit->holds(signal->si_addr)) {
    print_now(STDERR_FILENO, lost_page_line);
    print_now(STDOUT_FILENO, lost_page_json);
    ::_exit(static_cast<int>(ExitCode::CannotWrite));
  }
  std::signal(SIGBUS, SIG_DFL);  // the access comes again
}

void watch_for_lost_pages(const std::filesystem::path& folder, const Common& common) {
  const Failure failure = fail(Error::WriteFailed, folder.string() +
                                                       ": lost memory in a file there; is the disk "
                                                       "full?");
  lost_page_line = "\ncrease: " + failure.message + "\n";
  if (common.json) lost_page_json = failure_json(failure) + "\n";
  struct sigaction action {};
  action.sa_sigaction = on_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

std::filesystem::path choose_folder(const std::filesystem::path& output) {
  const char* temporary = std::getenv("TMPDIR");
  if (temporary != nullptr && *temporary != 0 && !MemoryLimit::is_in_memory(temporary)) {
    return temporary;
  }
  if (output.has_parent_path()) return output.parent_path();
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);  // messages name it
  return error ? "." : here;
}

}  // namespace

void add_memory_option(CLI::App& command, std::string& size) {
  command
      .add_option("--memory", size,
                  "keep to about so much memory, 4GB or 512MiB: what is beyond it is in a file "
                  "in TMPDIR, or beside the output; slower, with the same result. 0: no limit")
      ->type_name("SIZE")
      ->capture_default_str();
}

Result<MemoryOption> limit_memory(const std::string& size, const std::filesystem::path& output,
                                  const Common& common) {
  const Result<std::uint64_t> bytes = parse_memory(size);
  if (!bytes.ok()) return bytes.failure();
  if (*bytes == 0) return MemoryOption{};
  if (!kCanLimitMemory) {
    log(common, "  --memory: no limit, as this build has a sanitizer");
    return MemoryOption{};
  }
  const std::filesystem::path folder = choose_folder(output);
  if (MemoryLimit::is_in_memory(folder)) {
    log(common, "  --memory: " + folder.string() +
                    " is in memory itself, so that nothing is saved: set TMPDIR to one on a disk");
  }
  watch_for_lost_pages(folder, common);
  const Result<MemoryLimit*> limit = MemoryLimit::start({.bytes = *bytes, .folder = folder});
  if (!limit.ok()) return limit.failure();
  allocate_from(**limit);
  return MemoryOption{*bytes, folder};
}

std::uint64_t MemoryOption::spilled_bytes() const {
  const MemoryLimit* used = memory_limit();
  return used != nullptr ? used->spilled() : 0;
}

std::string MemoryOption::spilled_line() const {
  if (spilled_bytes() == 0) return "  memory: within " + in_bytes(limit) + ", nothing in a file";
  return "  memory: up to " + in_bytes(spilled_bytes()) + " in a file in " + folder.string();
}

std::optional<Failure> spill_failure() {
  allocate_without_limit();
  const MemoryLimit* used = memory_limit();
  if (used == nullptr || used->failure().empty()) return std::nullopt;
  return fail(Error::WriteFailed, used->failure());
}

}  // namespace crease::cli
