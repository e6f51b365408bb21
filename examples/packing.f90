! SPDX-License-Identifier: BSD-2-Clause
! packing.f90 - total contact force of a packing (bench/README has the format), by Hertz and with the coupling.
program packing
    use nlcontact
    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
    use, intrinsic :: iso_fortran_env, only: error_unit
    implicit none
    real(c_double), parameter :: reach = 0.3d0 ! gaps below this part of the mean radius make a candidate
    real(c_double), allocatable, target :: x(:, :), radius(:), wall_point(:, :), wall_normal(:, :)
    integer(c_int32_t), allocatable, target :: material(:), wall_material(:)
    type(nlc_material), allocatable, target :: materials(:)
    integer(c_int32_t), allocatable :: i(:), j(:)
    real(c_double) :: hertz, coupled
    character(len=1000) :: path

    call get_command_argument(1, path)
    call read_packing(trim(path))
    call list()
    hertz = total_force(NLC_MODEL_HERTZ)
    coupled = total_force(NLC_MODEL_GONZALEZ_CUITINO)
    print '(a,f0.6,a,f0.6,a,f0.3)', 'total force: Hertz ', hertz, ' N, Gonzalez-Cuitino ', coupled, ' N, ratio ', coupled / hertz

contains

    ! Twice: to count, and to read.
    subroutine read_packing(file)
        character(len=*), intent(in) :: file
        character(len=1000) :: line
        character(len=20) :: words(5)
        integer :: unit, status, pass, particles, walls, rows
        integer(c_int32_t) :: number, kind
        open (newunit=unit, file=file, status='old', action='read', iostat=status)
        if (status /= 0) call give_up('cannot read ' // file)
        do pass = 1, 2
            particles = 0
            walls = 0
            rows = 0
            rewind unit
            do
                read (unit, '(a)', iostat=status) line
                if (status /= 0) exit
                if ((line(1:11) == '# periodic:' .and. index(line, '1') > 0) .or. &
                    (line(1:7) == '# wall ' .and. index(line, ' rigid ') == 0)) call give_up( &
                    'this example has no periodic boxes and no walls that yield')
                if (line(1:7) == '# wall ') then
                    walls = walls + 1
                    if (pass == 2) read (line(index(line, 'point') + 5:), *) wall_point(:, walls), words(1), wall_normal(:, walls)
                else if (line(1:16) == '# material type ') then
                    rows = rows + 1
                    if (pass == 2) &
                        read (line(index(line, ':') + 1:), *) words(1), materials(rows)%young, words(2), materials(rows)%poisson
                else if (line(1:1) >= '0' .and. line(1:1) <= '9') then
                    particles = particles + 1
                    if (pass == 1) cycle
                    read (line, *) number, x(:, particles), radius(particles), kind
                    material(particles) = kind - 1 ! numbered from 0
                end if
            end do
            if (pass == 1) then
                allocate (x(3, particles), radius(particles), material(particles), materials(rows + 1))
                allocate (wall_point(3, walls), wall_normal(3, walls), wall_material(walls))
            end if
        end do
        close (unit)
        materials(rows + 1)%young = ieee_value(0d0, ieee_positive_inf) ! the walls': rigid
        wall_material = int(rows, c_int32_t)
    end subroutine

    ! All pairs with a gap below the reach, and all walls: quadratic, where a program has its neighbour lists.
    subroutine list()
        integer(c_int32_t) :: a, b, n
        real(c_double) :: height
        n = size(radius, kind=c_int32_t)
        allocate (i(0), j(0))
        do a = 1, n
            do b = a + 1, n
                if (norm2(x(:, b) - x(:, a)) < (1 + reach / 2) * (radius(a) + radius(b))) call append(a - 1, b - 1)
            end do
            do b = 1, size(wall_material, kind=c_int32_t)
                height = dot_product(x(:, a) - wall_point(:, b), wall_normal(:, b))
                if (height < (1 + reach) * radius(a)) call append(a - 1, n + b - 1)
            end do
        end do
    end subroutine

    subroutine append(a, b)
        integer(c_int32_t), intent(in) :: a, b
        i = [i, a]
        j = [j, b]
    end subroutine

    real(c_double) function total_force(model)
        integer(c_int32_t), intent(in) :: model
        type(nlc_particles) :: particles
        type(nlc_positions) :: positions
        type(nlc_options) :: options
        type(nlc_info) :: info
        type(c_ptr) :: network
        integer(c_size_t) :: bytes
        integer(c_int64_t) :: count
        integer(c_int32_t) :: status
        integer(c_int64_t), allocatable, target :: memory(:)
        real(c_double), allocatable :: overlap(:), normal(:, :), force(:), nonlocal(:)
        count = size(i, kind=c_int64_t)
        allocate (overlap(count), normal(3, count), force(count), nonlocal(count))
        particles%count = size(radius, kind=c_int64_t)
        particles%radius = c_loc(radius)
        particles%material = c_loc(material)
        particles%materials = c_loc(materials)
        particles%material_count = size(materials, kind=c_int64_t)
        particles%wall_material = c_loc(wall_material)
        particles%wall_count = size(wall_material, kind=c_int64_t)
        positions%x = c_loc(x(1, 1))
        positions%y = c_loc(x(2, 1))
        positions%z = c_loc(x(3, 1))
        positions%stride = 24
        positions%wall_point = c_loc(wall_point)
        positions%wall_normal = c_loc(wall_normal)
        options%model = model
        call check(nlc_contacts_from_pairs(overlap, normal, particles, positions, i, j, count))
        bytes = nlc_network_size(particles, count, options)
        allocate (memory(bytes / 8 + 1))
        bytes = 8 * size(memory, kind=c_size_t)
        call check(nlc_network_init(network, c_loc(memory), bytes, particles, i, j, count, options))
        nonlocal = 0
        status = nlc_solve(network, force, nonlocal, overlap, normal, info)
        call check(status, info)
        total_force = sum(force)
    end function

    ! Warnings pass.  With an info, which must not be an argument of the call that is checked, the culprit is told.
    subroutine check(status, info)
        integer(c_int32_t), intent(in) :: status
        type(nlc_info), intent(in), optional :: info
        character(len=30) :: culprit
        culprit = ''
        if (present(info)) write (culprit, '(a,i0)') ': ', info%culprit
        if (status < 0) call give_up(nlc_message(status) // trim(culprit))
    end subroutine

    subroutine give_up(text)
        character(len=*), intent(in) :: text
        write (error_unit, '(2a)') 'packing-fortran: ', text
        stop 1
    end subroutine
end program
