//! Riccati's algebraic equations: stabilising solutions, refined until their residual is rounding.

use super::dense::{
    blocks, eigenvalues, identity, inverse, is_finite, part, symmetric, transposed,
};
use super::{MatrixError, discrete_lyapunov, lyapunov};
use faer::Mat;
use faer::linalg::solvers::Solve;
use num_complex::Complex64;

/// Steps of the sign iteration.
const MOST_STEPS: usize = 80;
/// Doublings of the discrete equation.
const MOST_DOUBLINGS: usize = 60;
/// Relative residual (–) above which what was found is no solution.
const LARGEST_RESIDUAL: f64 = 1e-7;
/// Residual (–) by the equation's own matrices that is rounding, where the solution nearly is zero.
const ROUNDING: f64 = 1e-13;
/// Relative residual (–) at which a solution is refined no more.
const SMALL_RESIDUAL: f64 = 1e-14;
/// Steps of Newton's method on the stable subspace.
const CORRECTIONS: usize = 2;
/// Steps of Newton's method at the end.
const MOST_REFINEMENTS: usize = 4;

/// Stabilising solution X of Aᵀ X + X A − X R X + Q = 0: A − R X is stable. R and Q are symmetric, of any
/// sign.
///
/// The stable subspace of the Hamiltonian comes from its matrix sign function (Roberts 1980; Zhou, Doyle
/// and Glover 1996, §13.1-13.2), Newton's method (Kleinman 1968) then refines X.
pub fn riccati(a: &Mat<f64>, r: &Mat<f64>, q: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    if a.nrows() == 0 {
        return Ok(a.clone());
    }
    let stable = |matrix: &Mat<f64>| -> Result<bool, MatrixError> {
        Ok(eigenvalues(matrix)?.iter().all(|pole| pole.re < 0.0))
    };
    if q.norm_max() == 0.0 && stable(a)? {
        return Ok(q.clone());
    }
    // With X = s X′ the solution is of the size of one.
    let (size_a, size_r, size_q) = (a.norm_l2(), r.norm_l2(), q.norm_l2());
    let natural = (size_q / size_r).sqrt().max(size_a / size_r);
    let scale = if natural > 0.0 && natural.is_finite() { natural } else { 1.0 };
    let (r, q) = (scale * r, (1.0 / scale) * q);
    let hamiltonian = blocks(&[&[a, &(-&r)], &[&(-&q), &(-transposed(a))]]);
    let none = || no_solution(&hamiltonian);
    let first = of_sign(&hamiltonian).ok_or_else(none)?;
    let x = refined(a, &r, &q, first).ok_or_else(none)?;
    let closed = a - &r * &x;
    let is_solution = riccati_residual(a, &r, &q, &x) <= LARGEST_RESIDUAL
        || residual(a, &r, &q, &x).norm_l2() <= ROUNDING * (size_a + r.norm_l2() + q.norm_l2());
    if !is_solution || !stable(&closed)? {
        return Err(none());
    }
    Ok(scale * x)
}

/// Norm of Aᵀ X + X A − X R X + Q over the sum of its terms' norms (–).
pub fn riccati_residual(a: &Mat<f64>, r: &Mat<f64>, q: &Mat<f64>, x: &Mat<f64>) -> f64 {
    let (linear, square) = (x * a, x * r * x);
    let size = 2.0 * linear.norm_l2() + square.norm_l2() + q.norm_l2();
    residual(a, r, q, x).norm_l2() / size.max(f64::MIN_POSITIVE)
}

/// Aᵀ X + X A − X R X + Q.
fn residual(a: &Mat<f64>, r: &Mat<f64>, q: &Mat<f64>, x: &Mat<f64>) -> Mat<f64> {
    let linear = x * a;
    symmetric(&(&linear + linear.transpose() - x * r * x + q))
}

/// X from the matrix sign function S of the Hamiltonian: the stable subspace is that of (I; X).
fn of_sign(hamiltonian: &Mat<f64>) -> Option<Mat<f64>> {
    let n = hamiltonian.nrows() / 2;
    let mut sign = hamiltonian.clone();
    let mut scale_on = true;
    let mut settled = false;
    for _ in 0..MOST_STEPS {
        let turned = inverse(&sign)?;
        let scale = if scale_on { (turned.norm_l2() / sign.norm_l2()).sqrt() } else { 1.0 };
        let next = 0.5 * (scale * &sign + (1.0 / scale) * &turned);
        let change = (&next - &sign).norm_l2() / next.norm_l2();
        sign = next;
        if settled {
            break;
        }
        scale_on = scale_on && change > 1e-2;
        settled = change < 1e-8;
    }
    if !settled {
        return None;
    }
    // The range of I − S is the stable subspace: that of (U1; U2) with orthonormal columns, X = U2 U1⁻¹.
    let whole = (identity(2 * n) - sign).col_piv_qr().compute_Q();
    let mut basis = part(&whole, 0, 0, 2 * n, n);
    for _ in 0..CORRECTIONS {
        basis = corrected(hamiltonian, &basis)?;
    }
    let (top, bottom) = (part(&basis, 0, 0, n, n), part(&basis, n, 0, n, n));
    let x = transposed(&top).partial_piv_lu().solve(transposed(&bottom));
    is_finite(&x).then(|| symmetric(&x))
}

/// An orthonormal basis V of the stable subspace after one step of Newton's method in its own coordinates,
/// in which the correction is small however large X is.
///
/// With W = J V, which is at right angles to it, V + W Z is invariant to first order where Tᵀ Z + Z T = Wᵀ
/// H V with T = Vᵀ H V.
fn corrected(hamiltonian: &Mat<f64>, basis: &Mat<f64>) -> Option<Mat<f64>> {
    let n = basis.ncols();
    let beside = blocks(&[&[&(-part(basis, n, 0, n, n))], &[&part(basis, 0, 0, n, n)]]);
    let moved = hamiltonian * basis;
    let within = basis.transpose() * &moved;
    let error = symmetric(&(beside.transpose() * &moved));
    let step = lyapunov(&transposed(&within), &(-error)).ok()?;
    Some((basis + beside * step).qr().compute_thin_Q())
}

/// X after Newton's method, as long as it brings the residual down.
fn refined(a: &Mat<f64>, r: &Mat<f64>, q: &Mat<f64>, first: Mat<f64>) -> Option<Mat<f64>> {
    let mut best = (riccati_residual(a, r, q, &first), first);
    for _ in 0..MOST_REFINEMENTS {
        if best.0 < SMALL_RESIDUAL {
            break;
        }
        let closed = transposed(&(a - r * &best.1));
        let Ok(step) = lyapunov(&closed, &residual(a, r, q, &best.1)) else { break };
        let x = symmetric(&(&best.1 + &step));
        let left = riccati_residual(a, r, q, &x);
        // No number is no improvement either.
        if left.is_nan() || left >= best.0 {
            break;
        }
        best = (left, x);
    }
    best.0.is_finite().then_some(best.1)
}

/// The error with the eigenvalue that is nearest the imaginary axis.
fn no_solution(hamiltonian: &Mat<f64>) -> MatrixError {
    let values = match eigenvalues(hamiltonian) {
        Ok(values) => values,
        Err(error) => return error,
    };
    let nearest = values.into_iter().min_by(|a, b| a.re.abs().total_cmp(&b.re.abs()));
    MatrixError::NoStabilisingSolution { eigenvalue: nearest.unwrap_or_default() }
}

/// Stabilising solution X of X = Aᵀ X (I + G X)⁻¹ A + Q: (I + G X)⁻¹ A is stable. With G = B R⁻¹ Bᵀ it is
/// the equation of the regulator in discrete time.
///
/// By structure-preserving doubling (Chu, Fan, Lin and Wang, "Structure-preserving algorithms for periodic
/// discrete-time algebraic Riccati equations", Int. J. Control 77, 2004), then refined by Newton's method.
pub fn discrete_riccati(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    if a.nrows() == 0 {
        return Ok(a.clone());
    }
    let by_doubling = doubled(a, g, q).and_then(|x| discrete_refined(a, g, q, x));
    by_doubling
        .or_else(|| discrete_refined(a, g, q, by_cayley(a, g, q)?))
        .ok_or_else(|| no_discrete_solution(a, g, q))
}

/// X by doubling; none where it does not converge, as where Q shows no mode that is not stable.
fn doubled(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>) -> Option<Mat<f64>> {
    let (mut power, mut g_k, mut x) = (a.clone(), symmetric(g), symmetric(q));
    for _ in 0..MOST_DOUBLINGS {
        let solved = inverse(&(identity(a.nrows()) + &g_k * &x))?;
        let through = &power * &solved;
        let more = symmetric(&(power.transpose() * &x * &solved * &power));
        g_k = symmetric(&(&g_k + &through * &g_k * power.transpose()));
        power = &through * &power;
        let converged = more.norm_l2() <= 1e-15 * x.norm_l2() && power.norm_l2() < 1.0;
        x = &x + &more;
        if !is_finite(&x) || !is_finite(&g_k) {
            return None;
        }
        if converged {
            return Some(x);
        }
    }
    None
}

/// X from the matrix sign function of the symplectic pencil's Cayley transform, whose eigenvalues
/// (λ − 1)/(λ + 1) are in the left half plane where λ is inside the unit circle.
fn by_cayley(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>) -> Option<Mat<f64>> {
    let (one, none) = (identity(a.nrows()), Mat::zeros(a.nrows(), a.nrows()));
    let left = blocks(&[&[a, &none], &[&(-q), &one]]);
    let right = blocks(&[&[&one, g], &[&none, &transposed(a)]]);
    of_sign(&(inverse(&(&left + &right))? * (&left - &right)))
}

/// X after Newton's method, where it stabilises and its residual is small.
fn discrete_refined(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>, first: Mat<f64>) -> Option<Mat<f64>> {
    let mut best = (discrete_riccati_residual(a, g, q, &first), first);
    for _ in 0..MOST_REFINEMENTS {
        if best.0 < SMALL_RESIDUAL {
            break;
        }
        let (closed, next) = discrete_step(a, g, q, &best.1)?;
        let Ok(step) = discrete_lyapunov(&transposed(&closed), &(next - &best.1)) else { break };
        let x = symmetric(&(&best.1 + &step));
        let left = discrete_riccati_residual(a, g, q, &x);
        if left.is_nan() || left >= best.0 {
            break;
        }
        best = (left, x);
    }
    let (closed, _) = discrete_step(a, g, q, &best.1)?;
    let stable = eigenvalues(&closed).ok()?.iter().all(|pole| pole.norm() < 1.0);
    (stable && best.0 <= LARGEST_RESIDUAL).then_some(best.1)
}

/// (I + G X)⁻¹ A and Aᵀ X (I + G X)⁻¹ A + Q.
fn discrete_step(
    a: &Mat<f64>,
    g: &Mat<f64>,
    q: &Mat<f64>,
    x: &Mat<f64>,
) -> Option<(Mat<f64>, Mat<f64>)> {
    let closed = inverse(&(identity(a.nrows()) + g * x))? * a;
    let next = symmetric(&(a.transpose() * x * &closed + q));
    Some((closed, next))
}

/// Norm of Aᵀ X (I + G X)⁻¹ A + Q − X over the sum of its terms' norms (–); infinite where I + G X is
/// singular.
pub fn discrete_riccati_residual(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>, x: &Mat<f64>) -> f64 {
    let Some((_, next)) = discrete_step(a, g, q, x) else { return f64::INFINITY };
    let size = next.norm_l2() + q.norm_l2() + x.norm_l2();
    (&next - x).norm_l2() / size.max(f64::MIN_POSITIVE)
}

/// The error with the eigenvalue that is nearest the unit circle: of the symplectic pencil where A can be
/// inverted, else of A itself.
fn no_discrete_solution(a: &Mat<f64>, g: &Mat<f64>, q: &Mat<f64>) -> MatrixError {
    let pencil = inverse(a).map(|turned| {
        let turned = transposed(&turned);
        let corner = a + g * &turned * q;
        blocks(&[&[&corner, &(-(g * &turned))], &[&(-(&turned * q)), &turned]])
    });
    let values = match eigenvalues(pencil.as_ref().unwrap_or(a)) {
        Ok(values) => values,
        Err(error) => return error,
    };
    let away = |value: &Complex64| (value.norm() - 1.0).abs();
    let nearest = values.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    MatrixError::NoStabilisingSolution { eigenvalue: nearest.unwrap_or_default() }
}
