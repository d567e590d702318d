// Is a particle a loose grain? At a joint that still holds its piece it is not, though it has cracked.

// Of a joint that has parted two pieces; MPM_NO_JOINT has it too.
const uint PARTED = 0x80000000u;

bool is_loose(float apart, uint joint)
{
    return apart >= 0.0 && (joint & PARTED) != 0u;
}
