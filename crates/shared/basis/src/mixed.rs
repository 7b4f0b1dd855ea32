//! Numbers whose bits are mixed, for random numbers that belong to a seed and a place.

/// A number with the bits of `number` well mixed, so that neighbours have nothing in common.
///
/// Source: splitmix64, the output function of Steele, Lea, Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014 (variant 13 of Stafford).
pub fn mixed(number: u64) -> u64 {
    let a = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let b = (a ^ (a >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let c = (b ^ (b >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    c ^ (c >> 31)
}

#[cfg(test)]
mod tests {
    use super::mixed;

    /// The first numbers of the generator with seed 0, as its authors' reference code prints them.
    #[test]
    fn it_is_splitmix64() {
        assert_eq!(mixed(0), 0xE220_A839_7B1D_CDAF);
        assert_eq!(mixed(0x9E37_79B9_7F4A_7C15), 0x6E78_9E6A_A1B9_65F4);
    }
}
