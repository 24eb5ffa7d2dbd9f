# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Run over the C++ headers that lcm-gen makes. Their decoders allocate whatever length a message names before they
# look for its bytes: one broken byte in a length would cost up to 50 GB. Each element takes at least a byte, so
# more elements than bytes left are refused first. The length of a string counts its final zero; the decoders subtract
# that one, and would read 2 GB for the length 0x80000000. A zero within a string ends it: the encoders stop
# there, too, and what holds such a string could not be sent on. Strings of an array are named __elem.
s/^( *)this->([a-z_]+)\.resize\(this->([a-z_]+)\);/\1if(this->\3 < 0 || this->\3 > maxlen - pos) return -1;\n&/
s/if\((__[a-z_]+_len__|__elem_len) > maxlen - pos\) return -1;/if(\1 < 1 || \1 > maxlen - pos) return -1;/
s/\.assign\((\(\(const char\*\)buf\) \+ offset \+ pos), (__[a-z_]+_len__|__elem_len) - +1\);/.assign(\1, strnlen(\1, \2 - 1));/
