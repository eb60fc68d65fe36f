/* A disk on which each sync takes a tenth of a second; loaded before all else by tests/attacks.sh. */
#include <sys/syscall.h>
#include <unistd.h>

enum { microseconds = 100000 };

int fsync(int file) {
  usleep(microseconds);
  return (int)syscall(SYS_fsync, file);
}

int fdatasync(int file) {
  usleep(microseconds);
  return (int)syscall(SYS_fdatasync, file);
}
