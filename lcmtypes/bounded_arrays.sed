# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Run over the C++ headers that lcm-gen makes. Their decoders allocate whatever length a message names before they
# look for its bytes: one broken byte in a length would cost up to 50 GB. Each element takes at least a byte, so
# more elements than bytes left are refused first.
s/^( *)this->([a-z_]+)\.resize\(this->([a-z_]+)\);/\1if(this->\3 < 0 || this->\3 > maxlen - pos) return -1;\n&/
