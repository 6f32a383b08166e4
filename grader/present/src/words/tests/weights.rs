use super::*;

#[test]
fn weights_say_what_they_wrongly_depend_on() {
    let measured = |light, bsdf, sum| MeasuredWeights {
        light,
        bsdf,
        sum,
        deviation_at_first_vertex: if sum == [1.0; 2] { 0.0 } else { 1.0 },
        deviation_at_later_vertices: 2e-6,
        only_way: vec![OnlyWayWeight { light: OnlyWay::PointLight, weight: Some(0.5) }],
        points: Vec::new(),
    };
    let both = |form, sum| measured(form, form, sum);
    let wrong = |measured| {
        fails(Evidence::MisWeights(WeightTest {
            fault: Some(WeightFault::FirstVertex),
            measured: Some(measured),
        }))
    };
    let powers = WeightForm::Powers;
    for (text, expected) in [
        (
            wrong(measured(WeightForm::Constant(1.0), WeightForm::Constant(0.0), [2.0; 2])),
            "the two weights of a path sum to 2 instead of 1; the weights ignore the densities: they are always 1 for \
             light samples and 1 for BSDF samples",
        ),
        (
            wrong(measured(WeightForm::Constant(0.0), WeightForm::Constant(0.0), [1.0; 2])),
            "light samples have weight 0: this is BSDF sampling alone",
        ),
        (
            wrong(measured(WeightForm::Constant(1.0), WeightForm::Constant(1.0), [1.0; 2])),
            "lights that are hit have weight 0: this is next event estimation alone",
        ),
        (
            wrong(both(powers([-1.0, 0.0, 0.0, 0.0, 0.0]), [1.0; 2])),
            "in both weights, the densities are swapped: the weight falls as its own density rises",
        ),
        (
            wrong(both(powers([1.0, 2.0, 0.0, 0.0, 0.0]), [1.0; 2])),
            "in both weights, there is a spurious factor distance²",
        ),
        (
            wrong(both(powers([1.0, -2.0, 1.0, 0.0, 0.0]), [0.52, 1.713])),
            "the two weights of a path sum to between 0.52 and 1.713 instead of 1; in both weights, the density of the \
             light is per area, not per solid angle (spurious factors distance⁻² and cos θ)",
        ),
        (
            wrong(measured(powers([1.0, 0.0, 0.0, 1.0, 0.0]), powers([1.0, 0.0, 0.0, 0.0, 0.0]), [1.0, 1.5])),
            "the two weights of a path sum to between 1 and 1.5 instead of 1; in the weight of light samples, the density \
             of the light lacks the selection probability (spurious factor n for n lights)",
        ),
        (
            wrong(measured(WeightForm::Other, powers([1.0, 0.0, 0.0, 0.0, 0.0]), [1.0, 16.759])),
            "the two weights of a path sum to between 1 and 16.759 instead of 1; the weight of light samples is not a \
             simple function of the densities",
        ),
        (wrong(both(WeightForm::Other, [1.0; 2])), "neither weight is a simple function of the densities"),
        (
            fails(Evidence::MisWeights(WeightTest {
                fault: Some(WeightFault::OnlyWay(OnlyWay::PointLight)),
                measured: Some(both(powers([1.0, 0.0, 0.0, 0.0, 0.0]), [1.0; 2])),
            })),
            "a point light has weight 0.5 instead of 1: only one technique can find it",
        ),
        (
            fails(Evidence::MisWeights(WeightTest {
                fault: Some(WeightFault::NotANumber { light: 1e3, bsdf: 2e-5 }),
                measured: None,
            })),
            "a path returns NaN or infinity where the density per solid angle is 1.0e3 for the light sample and 2.0e-5 \
             for the BSDF sample",
        ),
        (
            passes(Evidence::MisWeights(WeightTest {
                fault: None,
                measured: Some(both(powers([1.0, 0.0, 0.0, 0.0, 0.0]), [1.0; 2])),
            })),
            "balance heuristic; the weights sum to 1 to within 2e-6",
        ),
    ] {
        assert_eq!(text, expected);
    }
}
