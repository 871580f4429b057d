#pragma once

namespace outrider::link {

/// Moves this process, and all that it starts from now on, into a network namespace of its own whose loopback carries
/// multicast. Needs no privilege where the kernel allows user namespaces; nothing is left behind. To be called while the
/// process has one thread. False when the kernel refuses; then nothing has changed, or the network is unusable.
bool enter_private_network();

}  // namespace outrider::link
