//! Kinds by numbers and names, which do not depend on the order of the disks.

use granular_edmd::trajectory::Reader;

use crate::corpus::check;

#[test]
fn whole_numbers_may_be_written_as_floats() {
    let table = |name: &str, kinds: [&str; 2]| {
        format!("x,y,radius,{name}\n1,1,.5,{1}\n3,1,.5,{0}\n5,1,.5,{1}\n", kinds[0], kinds[1])
    };
    let expected = "(1 1) r0.5 k2; (3 1) r0.5 k1; (5 1) r0.5 k2";
    for name in ["kind", "type", "species"] {
        for kinds in [["1", "2"], ["1.0", "2.0"], ["1.", "2.00"], ["1.000e+00", "2.000e+00"], ["1", "2.0"]] {
            check(&Reader::new(), &[(&table(name, kinds), expected)]);
        }
    }
    check(
        &Reader::new(),
        &[
            (
                "x,y,radius,kind\n1,1,.5,1.5\n",
                "refused: line 2: kind must be a whole number that fits into u16, but is \"1.5\"",
            ),
            (
                "x,y,radius,id\n1,1,.5,-1.0\n",
                "refused: line 2: id must be a whole number that fits into u64, but is \"-1.0\"",
            ),
            (
                "x,y,radius,id\n1,1,.5,1e300\n",
                "refused: line 2: id must be a whole number that fits into u64, but is \"1e300\"",
            ),
        ],
    );
}
