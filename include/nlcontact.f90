! SPDX-License-Identifier: BSD-2-Clause
!
! nlcontact.f90 - libnlcontact from Fortran.  Made from nlcontact.h by tools/fortran.py.
!
! The header and the man pages say what everything means; names and the order of arguments are theirs, but for F, which is
! total_force here.  Particles, walls, contacts and materials are numbered from 0.  Arrays [contacts][3] are (3, contacts).
! Optional arguments may be left out where C takes NULL.  Pointers in types are set with c_loc, to arrays that are targets, or c_funloc.
! Types hold their size (where pointers have 64 bits) and zeros from the start.
!
module nlcontact
    use, intrinsic :: iso_c_binding
    implicit none
    public

    integer(c_int32_t), parameter :: NLC_OK = 0
    integer(c_int32_t), parameter :: NLC_ERROR_NULL = -1
    integer(c_int32_t), parameter :: NLC_ERROR_NULL_FIELD = -2
    integer(c_int32_t), parameter :: NLC_ERROR_STRUCT_SIZE = -3
    integer(c_int32_t), parameter :: NLC_ERROR_RESERVED = -4
    integer(c_int32_t), parameter :: NLC_ERROR_COUNT = -5
    integer(c_int32_t), parameter :: NLC_ERROR_STRIDE = -6
    integer(c_int32_t), parameter :: NLC_ERROR_MEMORY_SIZE = -7
    integer(c_int32_t), parameter :: NLC_ERROR_ALIGNMENT = -8
    integer(c_int32_t), parameter :: NLC_ERROR_NETWORK = -9
    integer(c_int32_t), parameter :: NLC_ERROR_MODEL = -10
    integer(c_int32_t), parameter :: NLC_ERROR_NO_POTENTIAL = -11
    integer(c_int32_t), parameter :: NLC_ERROR_METHOD = -12
    integer(c_int32_t), parameter :: NLC_ERROR_OPTION = -13
    integer(c_int32_t), parameter :: NLC_ERROR_RADIUS = -14
    integer(c_int32_t), parameter :: NLC_ERROR_MATERIAL = -15
    integer(c_int32_t), parameter :: NLC_ERROR_YOUNG = -16
    integer(c_int32_t), parameter :: NLC_ERROR_POISSON = -17
    integer(c_int32_t), parameter :: NLC_ERROR_INDEX = -18
    integer(c_int32_t), parameter :: NLC_ERROR_WALL_WALL = -19
    integer(c_int32_t), parameter :: NLC_ERROR_RIGID_RIGID = -20
    integer(c_int32_t), parameter :: NLC_ERROR_STIFFNESS = -21
    integer(c_int32_t), parameter :: NLC_ERROR_OVERLAP = -22
    integer(c_int32_t), parameter :: NLC_ERROR_NORMAL = -23
    integer(c_int32_t), parameter :: NLC_ERROR_NONLOCAL = -24
    integer(c_int32_t), parameter :: NLC_ERROR_FORCE = -25
    integer(c_int32_t), parameter :: NLC_ERROR_TOTAL_FORCE = -26
    integer(c_int32_t), parameter :: NLC_ERROR_COINCIDENT = -27
    integer(c_int32_t), parameter :: NLC_ERROR_RANGE = -28
    integer(c_int32_t), parameter :: NLC_ERROR_UNSTABLE = -29
    integer(c_int32_t), parameter :: NLC_ERROR_SLIDING = -30
    integer(c_int32_t), parameter :: NLC_ERROR_POSITION = -31
    integer(c_int32_t), parameter :: NLC_ERROR_SAME_PLACE = -32
    integer(c_int32_t), parameter :: NLC_ERROR_CELL = -33
    integer(c_int32_t), parameter :: NLC_ERROR_CAPACITY = -34
    integer(c_int32_t), parameter :: NLC_ERROR_GHOST = -35
    integer(c_int32_t), parameter :: NLC_ERROR_REMOTE = -36
    integer(c_int32_t), parameter :: NLC_ERROR_CALLBACK = -37
    integer(c_int32_t), parameter :: NLC_WARNING_CLOSE = 1
    integer(c_int32_t), parameter :: NLC_WARNING_ROUNDING = 2
    integer(c_int32_t), parameter :: NLC_WARNING_WEAKENED = 4
    integer(c_int32_t), parameter :: NLC_WARNING_NOT_CONVERGED = 8
    integer(c_int32_t), parameter :: NLC_MODEL_GONZALEZ_CUITINO = 0
    integer(c_int32_t), parameter :: NLC_MODEL_HERTZ = 1
    integer(c_int32_t), parameter :: NLC_MODEL_HALF_SPACE = 2
    integer(c_int32_t), parameter :: NLC_MODEL_LOVE = 3
    integer(c_int32_t), parameter :: NLC_MODEL_SPHERE = 4
    integer(c_int32_t), parameter :: NLC_MODEL_POINT_FORCE = 5
    integer(c_int32_t), parameter :: NLC_POINTS_DEFORMED = 0
    integer(c_int32_t), parameter :: NLC_POINTS_UNDEFORMED = 1
    integer(c_int32_t), parameter :: NLC_METHOD_AUTOMATIC = 0
    integer(c_int32_t), parameter :: NLC_METHOD_FIXED_POINT = 1
    integer(c_int32_t), parameter :: NLC_SIMD_BEST = 0
    integer(c_int32_t), parameter :: NLC_SIMD_GENERIC = 1
    integer(c_int32_t), parameter :: NLC_SIMD_AVX2 = 2
    integer(c_int32_t), parameter :: NLC_SIMD_AVX512 = 3
    integer(c_int32_t), parameter :: NLC_SIMD_NEON = 4
    integer(c_int32_t), parameter :: NLC_REDUCE_SUM = 0
    integer(c_int32_t), parameter :: NLC_REDUCE_MAX = 1

    type, bind(c) :: nlc_material
        real(c_double) :: young = 0
        real(c_double) :: poisson = 0
    end type

    type, bind(c) :: nlc_particles
        integer(c_size_t) :: struct_size = 88
        integer(c_int64_t) :: count = 0
        type(c_ptr) :: radius = c_null_ptr
        integer(c_intptr_t) :: radius_stride = 0
        type(c_ptr) :: material = c_null_ptr
        integer(c_intptr_t) :: material_stride = 0
        type(c_ptr) :: materials = c_null_ptr
        integer(c_int64_t) :: material_count = 0
        integer(c_size_t) :: material_size = 16
        type(c_ptr) :: wall_material = c_null_ptr
        integer(c_int64_t) :: wall_count = 0
    end type

    type, bind(c) :: nlc_options
        integer(c_size_t) :: struct_size = 128
        integer(c_int32_t) :: model = 0
        integer(c_int32_t) :: method = 0
        real(c_double) :: tolerance = 0
        integer(c_int64_t) :: max_sweeps = 0
        real(c_double) :: prefactor = 0
        integer(c_int32_t) :: simd = 0
        integer(c_int32_t) :: points = 0
        type(c_ptr) :: stiffness = c_null_ptr
        type(c_ptr) :: cache = c_null_ptr
        integer(c_size_t) :: cache_size = 0
        type(c_funptr) :: parallel_for = c_null_funptr
        type(c_ptr) :: parallel_context = c_null_ptr
        integer(c_int64_t) :: owned_particles = 0
        type(c_funptr) :: exchange = c_null_funptr
        type(c_funptr) :: reduce = c_null_funptr
        type(c_ptr) :: context = c_null_ptr
        type(c_ptr) :: reserved = c_null_ptr
    end type

    type, bind(c) :: nlc_info
        integer(c_size_t) :: struct_size = 128
        integer(c_int64_t) :: culprit = 0
        integer(c_int64_t) :: sweeps = 0
        real(c_double) :: residual = 0
        integer(c_int64_t) :: worst_contact = 0
        integer(c_int64_t) :: active = 0
        real(c_double) :: lambda_lower = 0
        real(c_double) :: lambda_upper = 0
        integer(c_int64_t) :: critical_particle = 0
        real(c_double) :: coupling = 0
        integer(c_int64_t) :: weakest_particle = 0
        integer(c_int64_t) :: weakened = 0
        integer(c_int64_t) :: blocks = 0
        integer(c_int64_t) :: left_out = 0
        integer(c_int64_t) :: clusters = 0
        integer(c_int64_t) :: settled = 0
    end type

    type, bind(c) :: nlc_model_record
        integer(c_size_t) :: struct_size = 64
        type(c_ptr) :: name = c_null_ptr
        type(c_ptr) :: reference = c_null_ptr
        type(c_ptr) :: doi = c_null_ptr
        type(c_ptr) :: validity = c_null_ptr
        integer(c_int32_t) :: symmetric = 0
        integer(c_int32_t) :: potential = 0
        integer(c_int32_t) :: self_term = 0
        integer(c_int32_t) :: circles = 0
        real(c_double) :: cost = 0
    end type

    type, bind(c) :: nlc_positions
        integer(c_size_t) :: struct_size = 64
        type(c_ptr) :: x = c_null_ptr
        type(c_ptr) :: y = c_null_ptr
        type(c_ptr) :: z = c_null_ptr
        integer(c_intptr_t) :: stride = 0
        type(c_ptr) :: wall_point = c_null_ptr
        type(c_ptr) :: wall_normal = c_null_ptr
        type(c_ptr) :: cell = c_null_ptr
    end type

    type, bind(c) :: nlc_lists
        integer(c_size_t) :: struct_size = 56
        integer(c_int64_t) :: count = 0
        type(c_ptr) :: particle = c_null_ptr
        integer(c_int64_t) :: particle_count = 0
        type(c_ptr) :: length = c_null_ptr
        type(c_ptr) :: neighbour = c_null_ptr
        integer(c_int32_t) :: mask = 0
        integer(c_int32_t) :: reserved = 0
    end type

    interface
        function nlc_strerror(status) bind(c)
            import
            type(c_ptr) :: nlc_strerror
            integer(c_int32_t), value :: status
        end function

        function nlc_version() bind(c)
            import
            type(c_ptr) :: nlc_version
        end function

        function nlc_hertz_stiffness(E1, nu1, R1, E2, nu2, R2) bind(c)
            import
            real(c_double) :: nlc_hertz_stiffness
            real(c_double), value :: E1, nu1, R1, E2, nu2, R2
        end function

        function nlc_hertz_force(stiffness, overlap) bind(c)
            import
            real(c_double) :: nlc_hertz_force
            real(c_double), value :: stiffness, overlap
        end function

        function nlc_hertz_overlap(stiffness, force) bind(c)
            import
            real(c_double) :: nlc_hertz_overlap
            real(c_double), value :: stiffness, force
        end function

        function nlc_contact_radius(force, E1, nu1, R1, E2, nu2, R2) bind(c)
            import
            real(c_double) :: nlc_contact_radius
            real(c_double), value :: force, E1, nu1, R1, E2, nu2, R2
        end function

        function nlc_contact_displacement(force, radius, r, E, nu) bind(c)
            import
            real(c_double) :: nlc_contact_displacement
            real(c_double), value :: force, radius, r, E, nu
        end function

        function nlc_nonlocal_displacement(force, theta, R, E, nu) bind(c)
            import
            real(c_double) :: nlc_nonlocal_displacement
            real(c_double), value :: force, theta, R, E, nu
        end function

        function nlc_nonlocal_displacement_between(force, n_c, n_d, R, E, nu) bind(c)
            import
            real(c_double) :: nlc_nonlocal_displacement_between
            real(c_double), value :: force
            real(c_double), intent(in) :: n_c(3), n_d(3)
            real(c_double), value :: R, E, nu
        end function

        function nlc_half_space_displacement(force, n_k, n_c, r_kc, E, nu, prefactor) bind(c)
            import
            real(c_double) :: nlc_half_space_displacement
            real(c_double), value :: force
            real(c_double), intent(in) :: n_k(3), n_c(3), r_kc(3)
            real(c_double), value :: E, nu, prefactor
        end function

        subroutine nlc_point_displacement(displacement, force, theta, R, E, nu) bind(c)
            import
            real(c_double), intent(inout) :: displacement(2)
            real(c_double), value :: force, theta, R, E, nu
        end subroutine

        subroutine nlc_point_stress(stress, force, theta, R, nu) bind(c)
            import
            real(c_double), intent(inout) :: stress(4)
            real(c_double), value :: force, theta, R, nu
        end subroutine

        subroutine nlc_point_traction(traction, force, theta, R, nu) bind(c)
            import
            real(c_double), intent(inout) :: traction(2)
            real(c_double), value :: force, theta, R, nu
        end subroutine

        subroutine nlc_love_displacement(displacement, force, radius, r, z, E, nu) bind(c)
            import
            real(c_double), intent(inout) :: displacement(2)
            real(c_double), value :: force, radius, r, z, E, nu
        end subroutine

        subroutine nlc_love_stress(stress, force, radius, r, z, nu) bind(c)
            import
            real(c_double), intent(inout) :: stress(4)
            real(c_double), value :: force, radius, r, z, nu
        end subroutine

        function nlc_love_nonlocal_displacement(force, radius, theta, R, E, nu) bind(c)
            import
            real(c_double) :: nlc_love_nonlocal_displacement
            real(c_double), value :: force, radius, theta, R, E, nu
        end function

        function nlc_sphere_green(theta, nu) bind(c)
            import
            real(c_double) :: nlc_sphere_green
            real(c_double), value :: theta, nu
        end function

        function nlc_sphere_finite_size(theta, nu, chi) bind(c)
            import
            real(c_double) :: nlc_sphere_finite_size
            real(c_double), value :: theta, nu, chi
        end function

        function nlc_sphere_self(t, nu, chi) bind(c)
            import
            real(c_double) :: nlc_sphere_self
            real(c_double), value :: t, nu, chi
        end function

        function nlc_sphere_self_energy(t, nu, chi) bind(c)
            import
            real(c_double) :: nlc_sphere_self_energy
            real(c_double), value :: t, nu, chi
        end function

        function nlc_sphere_displacement(force, theta, R, E, nu) bind(c)
            import
            real(c_double) :: nlc_sphere_displacement
            real(c_double), value :: force, theta, R, E, nu
        end function

        function nlc_model_count() bind(c)
            import
            integer(c_int32_t) :: nlc_model_count
        end function

        function nlc_model_info(model, record, info) bind(c)
            import
            integer(c_int32_t) :: nlc_model_info
            integer(c_int32_t), value :: model
            type(nlc_model_record), intent(inout) :: record
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_model_find(name) bind(c)
            import
            integer(c_int32_t) :: nlc_model_find
            character(kind=c_char), intent(in) :: name(*)
        end function

        function nlc_network_size(particles, contact_count, options) bind(c)
            import
            integer(c_size_t) :: nlc_network_size
            type(nlc_particles), intent(in) :: particles
            integer(c_int64_t), value :: contact_count
            type(nlc_options), intent(in), optional :: options
        end function

        function nlc_network_init(network, memory, memory_size, particles, i, j, contact_count, options, info) bind(c)
            import
            integer(c_int32_t) :: nlc_network_init
            type(c_ptr), intent(inout) :: network
            type(c_ptr), value :: memory
            integer(c_size_t), value :: memory_size
            type(nlc_particles), intent(in) :: particles
            integer(c_int32_t), intent(in) :: i(*), j(*)
            integer(c_int64_t), value :: contact_count
            type(nlc_options), intent(in), optional :: options
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_set_options(network, options, info) bind(c)
            import
            integer(c_int32_t) :: nlc_set_options
            type(c_ptr), value :: network
            type(nlc_options), intent(in), optional :: options
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_cache_size(network) bind(c)
            import
            integer(c_size_t) :: nlc_cache_size
            type(c_ptr), value :: network
        end function

        function nlc_solve(network, force, nonlocal, overlap, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_solve
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: force(*), nonlocal(*)
            real(c_double), intent(in) :: overlap(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_predict(nonlocal, previous, count, ratio, info) bind(c)
            import
            integer(c_int32_t) :: nlc_predict
            real(c_double), intent(inout) :: nonlocal(*), previous(*)
            integer(c_int64_t), value :: count
            real(c_double), value :: ratio
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_sweep(network, displacement, force, overlap, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_sweep
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: displacement(*)
            real(c_double), intent(in) :: force(*)
            real(c_double), intent(in), optional :: overlap(*)
            real(c_double), intent(in) :: normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_energy(network, energy, force, overlap, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_energy
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: energy
            real(c_double), intent(in) :: force(*), overlap(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_tangent(network, dforce, doverlap, force, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_tangent
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: dforce(*)
            real(c_double), intent(in) :: doverlap(*), force(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_tangent_inverse(network, doverlap, dforce, force, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_tangent_inverse
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: doverlap(*)
            real(c_double), intent(in) :: dforce(*), force(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_tangent_bound(network, stiffness, force, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_tangent_bound
            type(c_ptr), value :: network
            real(c_double), intent(inout), optional :: stiffness(*)
            real(c_double), intent(in) :: force(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_assemble(network, total_force, total_force_stride, wall_force, force, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_assemble
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: total_force(*)
            integer(c_intptr_t), value :: total_force_stride
            real(c_double), intent(inout), optional :: wall_force(*)
            real(c_double), intent(in) :: force(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_assemble_turning(network, total_force, total_force_stride, force, overlap, normal, info) bind(c)
            import
            integer(c_int32_t) :: nlc_assemble_turning
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: total_force(*)
            integer(c_intptr_t), value :: total_force_stride
            real(c_double), intent(in) :: force(*), overlap(*), normal(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_assemble_sliding(network, total_force, total_force_stride, torque, torque_stride, wall_force, &
                force, normal, sliding, displacement, overlap, friction, info) bind(c)
            import
            integer(c_int32_t) :: nlc_assemble_sliding
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: total_force(*)
            integer(c_intptr_t), value :: total_force_stride
            real(c_double), intent(inout) :: torque(*)
            integer(c_intptr_t), value :: torque_stride
            real(c_double), intent(inout), optional :: wall_force(*)
            real(c_double), intent(in) :: force(*), normal(*), sliding(*)
            real(c_double), intent(in), optional :: displacement(*)
            real(c_double), intent(in) :: overlap(*)
            real(c_double), value :: friction
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_contacts_from_pairs(overlap, normal, particles, positions, i, j, contact_count, info) bind(c)
            import
            integer(c_int32_t) :: nlc_contacts_from_pairs
            real(c_double), intent(inout) :: overlap(*), normal(*)
            type(nlc_particles), intent(in) :: particles
            type(nlc_positions), intent(in) :: positions
            integer(c_int32_t), intent(in) :: i(*), j(*)
            integer(c_int64_t), value :: contact_count
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_contacts_from_lists(count, i, j, capacity, particles, positions, lists, reach, info) bind(c)
            import
            integer(c_int32_t) :: nlc_contacts_from_lists
            integer(c_int64_t), intent(inout) :: count
            integer(c_int32_t), intent(inout), optional :: i(*), j(*)
            integer(c_int64_t), value :: capacity
            type(nlc_particles), intent(in) :: particles
            type(nlc_positions), intent(in) :: positions
            type(nlc_lists), intent(in) :: lists
            real(c_double), value :: reach
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_reach(network, reach, displacement, force, info) bind(c)
            import
            integer(c_int32_t) :: nlc_reach
            type(c_ptr), value :: network
            real(c_double), intent(inout) :: reach
            real(c_double), intent(inout), optional :: displacement(*)
            real(c_double), intent(in) :: force(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_carry_size(contact_count, old_count) bind(c)
            import
            integer(c_size_t) :: nlc_carry_size
            integer(c_int64_t), value :: contact_count, old_count
        end function

        function nlc_carry(nonlocal, key, contact_count, old_nonlocal, old_key, old_count, memory, memory_size, &
                info) bind(c)
            import
            integer(c_int32_t) :: nlc_carry
            real(c_double), intent(inout) :: nonlocal(*)
            integer(c_int64_t), intent(in) :: key(*)
            integer(c_int64_t), value :: contact_count
            real(c_double), intent(in) :: old_nonlocal(*)
            integer(c_int64_t), intent(in) :: old_key(*)
            integer(c_int64_t), value :: old_count
            type(c_ptr), value :: memory
            integer(c_size_t), value :: memory_size
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_order(network, particle, contact, info) bind(c)
            import
            integer(c_int32_t) :: nlc_order
            type(c_ptr), value :: network
            integer(c_int32_t), intent(inout) :: particle(*)
            integer(c_int64_t), intent(inout) :: contact(*)
            type(nlc_info), intent(inout), optional :: info
        end function

        function nlc_network_update(network, particles, stiffness, info) bind(c)
            import
            integer(c_int32_t) :: nlc_network_update
            type(c_ptr), value :: network
            type(nlc_particles), intent(in) :: particles
            real(c_double), intent(in), optional :: stiffness(*)
            type(nlc_info), intent(inout), optional :: info
        end function
    end interface

contains

    ! The text of a status: nlc_strerror as a string.
    function nlc_message(status) result(text)
        integer(c_int32_t), intent(in) :: status
        character(len=:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        integer :: k
        call c_f_pointer(nlc_strerror(status), letters, [200])
        text = ''
        do k = 1, 200
            if (letters(k) == c_null_char) exit
            text = text // letters(k)
        end do
    end function
end module
