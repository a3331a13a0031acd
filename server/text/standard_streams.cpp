#include "text/standard_streams.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

namespace ziggurat::text {

void prepare_output() {
  open_standard_streams();
  ::signal(SIGXFSZ, SIG_IGN);
}

void open_standard_streams() {
  int file = 0;
  do {
    file = ::open("/dev/null", O_RDWR);  // the lowest number that is free
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) ::close(file);
}

}  // namespace ziggurat::text
