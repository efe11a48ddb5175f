"""Known answers of tests/stats/random_test.cc, computed without the product's code.

    python3 tests/known_answers/philox_stream.py

Philox4x32-10 (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011) in plain
integers, and the stream built on it: Box-Muller by math.log and math.cos, Lemire's bounded integers,
Fisher-Yates.
"""

import math

MASK = 0xFFFFFFFF


def philox4x32(counter, key):
    c, k = list(counter), list(key)
    for _ in range(10):
        first, second = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [(second >> 32) ^ c[1] ^ k[0], second & MASK, (first >> 32) ^ c[3] ^ k[1], first & MASK]
        k = [(k[0] + 0x9E3779B9) & MASK, (k[1] + 0xBB67AE85) & MASK]
    return c


class Stream:
    def __init__(self, seed, condition, trial, purpose):
        self.key = [seed & MASK, seed >> 32]
        self.name = [trial, condition, purpose]
        self.block = 0
        self.words = []
        self.spare = None

    def next32(self):
        if not self.words:
            self.words = philox4x32([self.block] + self.name, self.key)
            self.block += 1
        return self.words.pop(0)

    def uniform(self):
        low = self.next32()
        return ((low | (self.next32() << 32)) >> 11) / 2.0**53

    def normal(self):
        if self.spare is not None:
            value, self.spare = self.spare, None
            return value
        radius = math.sqrt(-2.0 * math.log(1.0 - self.uniform()))
        angle = 2.0 * math.pi * self.uniform()
        self.spare = radius * math.sin(angle)
        return radius * math.cos(angle)

    def integer_below(self, n):
        # Of the 2^32 words, the multiples w n whose low half is below 2^32 mod n are one too many.
        while True:
            product = self.next32() * n
            if (product & MASK) >= 2**32 % n:
                return product >> 32

    def shuffled(self, count):
        items = list(range(count))
        for i in range(count, 1, -1):
            j = self.integer_below(i)
            items[i - 1], items[j] = items[j], items[i - 1]
        return items


def make():
    return Stream(0x0123456789ABCDEF, 7, 11, 3)


def show(title, values):
    print(title)
    print("    " + ", ".join(values))


def main():
    for counter, key in (
        ([0] * 4, [0] * 2),
        ([MASK] * 4, [MASK] * 2),
        ([0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344], [0xA4093822, 0x299F31D0]),
    ):
        show("Philox4x32-10", [f"{word:#010x}" for word in philox4x32(counter, key)])
    print("stream {seed 0x0123456789abcdef, condition 7, trial 11, purpose 3}")
    s = make()
    show("Next32", [f"{s.next32():#010x}u" for _ in range(10)])
    s = make()
    show("Uniform", [float.hex(s.uniform()) for _ in range(6)])
    s = make()
    show("Normal", [repr(s.normal()) for _ in range(8)])
    s = make()
    show("IntegerBelow 1, 2, 6, 1000, 3 * 2^30 eight times, 2^32 - 1",
         [f"{s.integer_below(n)}u" for n in [1, 2, 6, 1000] + [3 * 2**30] * 8 + [MASK]])
    s = make()
    show("Shuffle of 0..9", [str(i) for i in s.shuffled(10)])
    s = make()
    for _ in range(100000):
        last = s.next32()
    show("the 100000th word", [f"{last:#010x}u"])


if __name__ == "__main__":
    main()
