//! Runs code.

use super::code::{Code, Instruction, Operation as O};
use crate::noise::Noise;

/// Looks on while code runs.
pub(super) trait Watch {
    /// An instruction is executed.
    #[inline]
    fn executed(&mut self) {}

    /// Instruction number `at` has put a value into its register; `registers` are those before.
    fn before(&mut self, at: usize, instruction: &Instruction, value: f64, registers: &[f64]);
}

/// Nobody looks on.
impl Watch for () {
    #[inline]
    fn before(&mut self, _: usize, _: &Instruction, _: f64, _: &[f64]) {}
}

/// Runs `code` from its first instruction to its end. `N` is a power of two and at least [`Code::registers`]: so no access
/// needs a check. Jumps lead forward but for counted loops, so the end is reached.
#[inline]
pub(super) fn run<const N: usize>(
    code: &Code,
    registers: &mut [f64; N],
    noise: Noise,
    watch: &mut impl Watch,
) {
    const { assert!(N.is_power_of_two()) };
    let mut at = 0;
    while let Some(instruction) = code.instructions.get(at) {
        watch.executed();
        let Instruction { operation, to, a, b, c } = *instruction;
        let of = |register: u16| usize::from(register) & (N - 1);
        let [first, second] = [registers[of(a)], registers[of(b)]];
        let passes = match operation {
            O::Jump => false,
            O::JumpUnless => first != 0.0,
            O::JumpUnlessLess => first < second,
            O::JumpUnlessLessOrEqual => first <= second,
            O::Again => {
                registers[of(a)] = first + 1.0;
                first + 1.0 > second
            }
            O::Noise => {
                let value = noise.normal(first as u64);
                watch.before(at, instruction, value, registers);
                registers[of(to)] = value;
                true
            }
            _ => {
                let value = operation.value(first, second, registers[of(c)]);
                watch.before(at, instruction, value, registers);
                registers[of(to)] = value;
                true
            }
        };
        at = if passes { at + 1 } else { usize::from(to) };
    }
}
