#!/usr/bin/env python3
"""Print powers_of_ten.inc: 10^k, k = -292 .. 324, as 128-bit fractions rounded up.

    python3 cli/powers_of_ten.py > cli/powers_of_ten.inc
"""

print("/* {high, low} of ceil(10^k / 2^e) with 2^127 <= 10^k / 2^e < 2^128, k = -292 .. 324.")
print(" * Made by powers_of_ten.py.")
print(" *")
print(" * SPDX-License-Identifier: GPL-3.0-or-later */")
for k in range(-292, 325):
    if k >= 0:
        power = 10**k
        shift = power.bit_length() - 128
        g = power << -shift if shift <= 0 else -(-power >> shift)
    else:
        power = 10**-k
        g = -(-(1 << (127 + power.bit_length())) // power)
    assert g.bit_length() == 128, k
    print(f"{{0x{g >> 64:016x}, 0x{g & (2**64 - 1):016x}}},")
